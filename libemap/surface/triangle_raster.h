#pragma once

// The points of the integer grid under a triangle, with the triangle's height over each: exact, edges included.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace emap {

// corners: (x, y) in grid steps and a height, in either orientation. Calls visit(x, y, height) for every whole (x, y)
// inside the triangle's projection or on its edges (within 1e-9 steps, so that no point falls between two triangles at
// an edge that they share). A triangle whose projection has no area is not visited.
template <class Visitor>
void rasterise_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Visitor& visit) {
  constexpr double kTolerance = 1e-9;
  const Eigen::Vector3d &a = corners[0], &b = corners[1], &c = corners[2];
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (area == 0 || !std::isfinite(area)) return;
  const auto [low_x, high_x] = std::minmax({a.x(), b.x(), c.x()});
  const auto [low_y, high_y] = std::minmax({a.y(), b.y(), c.y()});
  const auto first_x = static_cast<std::int32_t>(std::ceil(low_x - kTolerance));
  const auto last_x = static_cast<std::int32_t>(std::floor(high_x + kTolerance));
  const auto first_y = static_cast<std::int32_t>(std::ceil(low_y - kTolerance));
  const auto last_y = static_cast<std::int32_t>(std::floor(high_y + kTolerance));
  if (first_x > last_x || first_y > last_y) return;
  // Barycentric weights are linear in x and y; an edge's tolerance is a distance, so it is scaled by the edge's length.
  const double inverse = 1 / area;
  const double step_b_x = (c.y() - a.y()) * inverse, step_b_y = -(c.x() - a.x()) * inverse;
  const double step_c_x = -(b.y() - a.y()) * inverse, step_c_y = (b.x() - a.x()) * inverse;
  const double slack_b = kTolerance * (std::abs(step_b_x) + std::abs(step_b_y));
  const double slack_c = kTolerance * (std::abs(step_c_x) + std::abs(step_c_y));
  const double slack_a = kTolerance * (std::abs(step_b_x + step_c_x) + std::abs(step_b_y + step_c_y));
  for (std::int32_t y = first_y; y <= last_y; ++y)
    for (std::int32_t x = first_x; x <= last_x; ++x) {
      const double weight_b = step_b_x * (x - a.x()) + step_b_y * (y - a.y());
      const double weight_c = step_c_x * (x - a.x()) + step_c_y * (y - a.y());
      if (weight_b < -slack_b || weight_c < -slack_c || weight_b + weight_c > 1 + slack_a) continue;
      const double height = a.z() + weight_b * (b.z() - a.z()) + weight_c * (c.z() - a.z());
      visit(x, y, std::clamp(height, std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})));
    }
}

}  // namespace emap
