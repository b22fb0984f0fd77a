#pragma once

// Meshes of known shape, and slow, obvious truths about meshes.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libemap/surface/surface.h"
#include "libemap/surface/triangle_tree.h"

namespace emap::test {

// A grid of (columns + 1) x (rows + 1) vertices, place(u, v) for u and v in [0, 1], triangles counter-clockwise in (u,
// v).
template <class Place>
Mesh grid_mesh(std::uint32_t columns, std::uint32_t rows, const Place& place) {
  Mesh mesh;
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t column = 0; column <= columns; ++column)
      mesh.positions.push_back(place(static_cast<double>(column) / columns, static_cast<double>(row) / rows));
  const auto index = [&](std::uint32_t row, std::uint32_t column) { return row * (columns + 1) + column; };
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = index(row, column), b = index(row, column + 1), c = index(row + 1, column + 1),
                          d = index(row + 1, column);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

// Merges vertices at the same place to within 1e-9 and drops triangles that lose a corner: closes seams and poles.
inline Mesh welded(const Mesh& mesh) {
  Mesh result;
  std::vector<std::uint32_t> index;
  for (const Eigen::Vector3d& position : mesh.positions) {
    const auto same = std::find_if(result.positions.rbegin(), result.positions.rend(),
                                   [&](const Eigen::Vector3d& other) { return (other - position).norm() < 1e-9; });
    index.push_back(static_cast<std::uint32_t>(result.positions.rend() - same) - 1);
    if (same == result.positions.rend()) index.back() = static_cast<std::uint32_t>(result.positions.size());
    if (same == result.positions.rend()) result.positions.push_back(position);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    if (index[a] != index[b] && index[b] != index[c] && index[a] != index[c])
      result.triangles.push_back({index[a], index[b], index[c]});
  return result;
}

inline Mesh sphere(std::uint32_t rows, double radius = 1) {
  return welded(grid_mesh(2 * rows, rows, [radius](double u, double v) {
    const double longitude = 2 * std::numbers::pi * u, latitude = std::numbers::pi * (v - 0.5);
    return Eigen::Vector3d(radius * std::cos(latitude) * std::cos(longitude),
                           radius * std::cos(latitude) * std::sin(longitude), radius * std::sin(latitude));
  }));
}

inline Mesh torus(std::uint32_t rows) {
  return welded(grid_mesh(2 * rows, rows, [](double u, double v) {
    const double around = 2 * std::numbers::pi * u, across = 2 * std::numbers::pi * v;
    const double distance = 2 + std::cos(across);
    return Eigen::Vector3d(distance * std::cos(around), distance * std::sin(around), std::sin(across));
  }));
}

// A gentle landscape over the unit square.
inline Mesh waves(std::uint32_t cells) {
  return grid_mesh(cells, cells,
                   [](double u, double v) { return Eigen::Vector3d(u, v, 0.05 * std::sin(9 * u) * std::cos(7 * v)); });
}

// A ramp that winds 2.5 times around an axis: every normal is near the axis, but it lies over itself.
inline Mesh spiral_ramp(std::uint32_t cells) {
  return grid_mesh(6 * cells, cells, [](double u, double v) {
    const double angle = 5 * std::numbers::pi * u, radius = 1 + v;
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.2 * angle);
  });
}

inline double brute_distance(const Mesh& mesh, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    nearest = std::min(
        nearest, (closest_on_triangle(point, mesh.positions[a], mesh.positions[b], mesh.positions[c]) - point).norm());
  return nearest;
}

}  // namespace emap::test
