#pragma once

// Unit normals as two 16-bit angles (thesis, 5.2.1): to within 0.003 degrees.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace emap {

// The angle to the z-axis, 0 to 65535 for 0 to pi, and the angle around it from the x-axis, 0 to 65535 for -pi to pi:
// over a patch the z-axis is its plane's normal.
using PolarNormal = std::array<std::uint16_t, 2>;

inline PolarNormal polar_normal(const Eigen::Vector3d& normal) {
  const double from_axis = std::acos(std::clamp(normal.z(), -1.0, 1.0)) / std::numbers::pi;
  const double around = std::atan2(normal.y(), normal.x()) / std::numbers::pi;
  return {static_cast<std::uint16_t>(std::lround(65535 * from_axis)),
          static_cast<std::uint16_t>(std::lround(65535 * (0.5 + 0.5 * around)))};
}

inline Eigen::Vector3d normal_of(const PolarNormal& polar) {
  const double from_axis = std::numbers::pi * polar[0] / 65535;
  const double around = std::numbers::pi * (2.0 * polar[1] / 65535 - 1);
  return {std::sin(from_axis) * std::cos(around), std::sin(from_axis) * std::sin(around), std::cos(from_axis)};
}

}  // namespace emap
