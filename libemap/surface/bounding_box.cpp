#include "libemap/surface/bounding_box.h"

namespace emap {

BoundingBox bounding_box(const std::vector<Eigen::Vector3d>& positions) {
  if (positions.empty()) return {};
  BoundingBox box{positions.front(), positions.front()};
  for (const Eigen::Vector3d& position : positions) {
    box.minimum = box.minimum.cwiseMin(position);
    box.maximum = box.maximum.cwiseMax(position);
  }
  return box;
}

}  // namespace emap
