#pragma once

// A surface as elevation maps: one regular grid of elevations over each patch's base plane (thesis, 3.3.1, 3.3.3).

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace emap {

// Orthonormal and right-handed: axis_u x axis_v = normal.
struct BasePlane {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // position of sample (0, 0) at elevation 0
  Eigen::Vector3d axis_u = Eigen::Vector3d::UnitX();
  Eigen::Vector3d axis_v = Eigen::Vector3d::UnitY();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

struct ElevationPatch {
  BasePlane plane;
  std::uint32_t columns = 0, rows = 0;
  std::vector<std::uint8_t> mask;  // rows x columns, row by row: 1 = the surface is here
  std::vector<double> elevation;   // rows x columns, model units; 0 outside the mask
};

struct ElevationMaps {
  double spacing = 0;   // between neighbouring samples of every patch, along both axes
  double diagonal = 0;  // of the bounding box of the original surface
  Eigen::Vector3d box_minimum = Eigen::Vector3d::Zero();
  std::vector<ElevationPatch> patches;
};

// Position of a sample: origin + column * spacing * axis_u + row * spacing * axis_v + elevation * normal.
Eigen::Vector3d sample_position(const ElevationPatch& patch, double spacing, std::uint32_t row, std::uint32_t column);

}  // namespace emap
