#include "libemap/elevation/canonical_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libemap/elevation/grid_triangles.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// Number of samples before each patch, and in all.
std::vector<std::uint32_t> first_samples(const ElevationMaps& maps) {
  std::vector<std::uint32_t> first(maps.patches.size() + 1, 0);
  for (std::size_t patch = 0; patch < maps.patches.size(); ++patch)
    first[patch + 1] = first[patch] + static_cast<std::uint32_t>(std::count(maps.patches[patch].mask.begin(),
                                                                            maps.patches[patch].mask.end(), 1));
  return first;
}

void place_samples(const ElevationPatch& patch, double spacing, std::uint32_t first,
                   std::vector<Eigen::Vector3d>& positions) {
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      if (patch.mask[std::size_t{row} * patch.columns + column])
        positions[first++] = sample_position(patch, spacing, row, column);
}

// Indices of the samples, one for each place of the map.
std::vector<std::uint32_t> sample_indices(const ElevationPatch& patch, std::uint32_t first) {
  std::vector<std::uint32_t> indices(patch.mask.size());
  for (std::size_t place = 0; place < indices.size(); ++place) indices[place] = patch.mask[place] ? first++ : first;
  return indices;
}

std::vector<std::array<std::uint32_t, 3>> patch_triangles(const ElevationPatch& patch, double spacing,
                                                          std::uint32_t first, double steepest_slope) {
  const std::vector<std::uint32_t> indices = sample_indices(patch, first);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(2 * indices.size());
  visit_grid_triangles(patch, [&](const GridTriangle& triangle) {
    if (slope_of(patch, triangle, spacing) <= steepest_slope)
      triangles.push_back({indices[triangle[0]], indices[triangle[1]], indices[triangle[2]]});
  });
  return triangles;
}

Eigen::Vector3d sample_normal(const ElevationPatch& patch, double spacing, std::uint32_t row, std::uint32_t column) {
  const auto place = [&](std::uint32_t r, std::uint32_t c) { return std::size_t{r} * patch.columns + c; };
  // The mean slope over the supported neighbours on either side.
  const auto slope = [&](bool has_before, std::size_t before, bool has_after, std::size_t after) {
    const std::size_t here = place(row, column);
    has_before = has_before && patch.mask[before];
    has_after = has_after && patch.mask[after];
    if (!has_before && !has_after) return 0.0;
    const double steps = (has_before ? 1.0 : 0.0) + (has_after ? 1.0 : 0.0);
    return (patch.elevation[has_after ? after : here] - patch.elevation[has_before ? before : here]) /
           (steps * spacing);
  };
  const double slope_u = slope(column > 0, place(row, column) - 1, column + 1 < patch.columns, place(row, column) + 1);
  const double slope_v =
      slope(row > 0, place(row, column) - patch.columns, row + 1 < patch.rows, place(row, column) + patch.columns);
  const BasePlane& plane = patch.plane;
  return (plane.normal - slope_u * plane.axis_u - slope_v * plane.axis_v).normalized();
}

}  // namespace

Mesh canonical_mesh(const ElevationMaps& maps, const CanonicalOptions& options) {
  const std::vector<std::uint32_t> first = first_samples(maps);
  const double steepest_slope = std::tan(options.steepest_degrees * std::numbers::pi / 180);
  Mesh mesh;
  mesh.positions.resize(first.back());
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles(maps.patches.size());
  thin::parallel_ranges(maps.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t patch = begin; patch < end; ++patch) {
      place_samples(maps.patches[patch], maps.spacing, first[patch], mesh.positions);
      triangles[patch] = patch_triangles(maps.patches[patch], maps.spacing, first[patch], steepest_slope);
    }
  });
  std::size_t count = 0;
  for (const auto& part : triangles) count += part.size();
  mesh.triangles.reserve(count);
  for (const auto& part : triangles) mesh.triangles.insert(mesh.triangles.end(), part.begin(), part.end());
  return mesh;
}

std::vector<std::uint32_t> patches_of_samples(const ElevationMaps& maps) {
  const std::vector<std::uint32_t> first = first_samples(maps);
  std::vector<std::uint32_t> patches(first.back());
  for (std::uint32_t patch = 0; patch < maps.patches.size(); ++patch)
    std::fill(patches.begin() + first[patch], patches.begin() + first[patch + 1], patch);
  return patches;
}

PointSet sample_points(const ElevationMaps& maps) {
  const std::vector<std::uint32_t> first = first_samples(maps);
  PointSet points;
  points.positions.resize(first.back());
  points.normals.resize(first.back());
  thin::parallel_ranges(maps.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ElevationPatch& patch = maps.patches[i];
      place_samples(patch, maps.spacing, first[i], points.positions);
      std::uint32_t sample = first[i];
      for (std::uint32_t row = 0; row < patch.rows; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column)
          if (patch.mask[std::size_t{row} * patch.columns + column])
            points.normals[sample++] = sample_normal(patch, maps.spacing, row, column);
    }
  });
  return points;
}

}  // namespace emap
