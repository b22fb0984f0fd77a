#include "libemap/partition/footprints.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libemap/surface/mesh_normals.h"
#include "libemap/surface/triangle_raster.h"

namespace emap {

namespace {

constexpr double kUpright = 1e-3;  // cosine between an element's normal and the plane's

std::optional<Slopes> slopes_of(const Eigen::Vector3d& normal, const PlaneAxes& axes) {
  const double along = axes.normal.dot(normal);
  if (!(std::abs(along) >= kUpright)) return std::nullopt;
  return Slopes{static_cast<float>(-axes.u.dot(normal) / along), static_cast<float>(-axes.v.dot(normal) / along)};
}

}  // namespace

PlaneAxes axes_around(const Eigen::Vector3d& normal) {
  // The coordinate axis that is least along the normal is farthest from degenerate.
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = Eigen::Vector3d::Unit(least).cross(normal).normalized();
  return {u, normal.cross(u), normal};
}

Cell Footprints::centre_cell(std::uint32_t element, const PlaneAxes& axes, const Slopes& slopes) const {
  const Eigen::Vector3d offset = centre_of(element) - origin_;
  const double u = axes.u.dot(offset) / cell_size_, v = axes.v.dot(offset) / cell_size_;
  const double rise = slopes.u * (std::floor(u) + 0.5 - u) + slopes.v * (std::floor(v) + 0.5 - v);
  return {static_cast<std::int32_t>(std::floor(u)), static_cast<std::int32_t>(std::floor(v)),
          static_cast<float>(axes.normal.dot(offset) + cell_size_ * rise)};
}

Eigen::Vector3d TriangleFootprints::centre_of(std::uint32_t element) const {
  const auto& [a, b, c] = mesh_.triangles[element];
  return (mesh_.positions[a] + mesh_.positions[b] + mesh_.positions[c]) / 3;
}

std::optional<Slopes> TriangleFootprints::append_cells(std::uint32_t element, const PlaneAxes& axes,
                                                       std::vector<Cell>& cells) const {
  std::array<Eigen::Vector3d, 3> corners;  // in cells, cell centres at whole numbers
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d offset = mesh_.positions[mesh_.triangles[element][i]] - origin_;
    corners[i] = {axes.u.dot(offset) / cell_size_ - 0.5, axes.v.dot(offset) / cell_size_ - 0.5,
                  axes.normal.dot(offset)};
  }
  rasterise_triangle(corners, [&](std::int32_t u, std::int32_t v, double height) {
    cells.push_back({u, v, static_cast<float>(height)});
  });
  return slopes_of(scaled_normal(mesh_, mesh_.triangles[element]).normalized(), axes);
}

std::optional<Slopes> DiscFootprints::append_cells(std::uint32_t element, const PlaneAxes& axes,
                                                   std::vector<Cell>& cells) const {
  const Eigen::Vector3d& normal = graph_.normals[element];
  const double along = axes.normal.dot(normal);
  // Discs that stand upright leave no footprint.
  if (std::abs(along) < kUpright) return std::nullopt;
  const Eigen::Vector3d offset = graph_.centres[element] - origin_;
  const double slope_u = -axes.u.dot(normal) / along, slope_v = -axes.v.dot(normal) / along;
  const double centre_u = axes.u.dot(offset), centre_v = axes.v.dot(offset), height = axes.normal.dot(offset);
  const double radius_squared = graph_.areas[element] / std::numbers::pi, radius = std::sqrt(radius_squared);
  const auto first = [&](double centre) {
    return static_cast<std::int32_t>(std::ceil((centre - radius) / cell_size_ - 0.5));
  };
  const auto last = [&](double centre) {
    return static_cast<std::int32_t>(std::floor((centre + radius) / cell_size_ - 0.5));
  };
  for (std::int32_t v = first(centre_v); v <= last(centre_v); ++v)
    for (std::int32_t u = first(centre_u); u <= last(centre_u); ++u) {
      const double du = (u + 0.5) * cell_size_ - centre_u, dv = (v + 0.5) * cell_size_ - centre_v;
      const double rise = slope_u * du + slope_v * dv;
      if (du * du + dv * dv + rise * rise <= radius_squared) cells.push_back({u, v, static_cast<float>(height + rise)});
    }
  return slopes_of(normal, axes);
}

}  // namespace emap
