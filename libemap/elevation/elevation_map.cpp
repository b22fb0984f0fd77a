#include "libemap/elevation/elevation_map.h"

namespace emap {

Eigen::Vector3d sample_position(const ElevationPatch& patch, double spacing, std::uint32_t row, std::uint32_t column) {
  const BasePlane& plane = patch.plane;
  return plane.origin + column * spacing * plane.axis_u + row * spacing * plane.axis_v +
         patch.elevation[static_cast<std::size_t>(row) * patch.columns + column] * plane.normal;
}

}  // namespace emap
