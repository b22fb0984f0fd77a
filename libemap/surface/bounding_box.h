#pragma once

// Axis-aligned bounding boxes. Their diagonal is the unit of every error that libemap states.

#include "libemap/surface/surface.h"

namespace emap {

struct BoundingBox {
  Eigen::Vector3d minimum = Eigen::Vector3d::Zero();
  Eigen::Vector3d maximum = Eigen::Vector3d::Zero();

  double diagonal() const { return (maximum - minimum).norm(); }
};

// Of all positions, used by a triangle or not; the box of nothing is a point at the origin.
BoundingBox bounding_box(const std::vector<Eigen::Vector3d>& positions);

}  // namespace emap
