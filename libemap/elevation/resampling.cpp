#include "libemap/elevation/resampling.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libemap/elevation/map_grid.h"
#include "libemap/surface/bounding_box.h"
#include "libemap/surface/mesh_normals.h"
#include "libemap/surface/triangle_raster.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// A triangle's corners over the plane: u and v in samples, the elevation in model units.
std::array<Eigen::Vector3d, 3> corners_over(const BasePlane& plane, double spacing, const Mesh& mesh,
                                            const std::array<std::uint32_t, 3>& triangle) {
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = over_plane(plane, spacing, mesh.positions[triangle[i]]);
  return corners;
}

ElevationPatch resample_patch(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const BasePlane& plane,
                              double spacing) {
  double last_u = -1, last_v = -1;
  for (const std::uint32_t triangle : triangles)
    for (const Eigen::Vector3d& corner : corners_over(plane, spacing, mesh, mesh.triangles[triangle])) {
      last_u = std::max(last_u, corner.x());
      last_v = std::max(last_v, corner.y());
    }
  ElevationPatch patch = empty_patch(plane, last_u, last_v);
  const auto columns = static_cast<std::int32_t>(patch.columns), rows = static_cast<std::int32_t>(patch.rows);
  for (const std::uint32_t triangle : triangles)
    rasterise_triangle(corners_over(plane, spacing, mesh, mesh.triangles[triangle]),
                       [&](std::int32_t column, std::int32_t row, double elevation) {
                         if (column < 0 || row < 0 || column >= columns || row >= rows) return;
                         const auto place =
                             static_cast<std::size_t>(row) * patch.columns + static_cast<std::size_t>(column);
                         if (patch.mask[place] == 0 || elevation > patch.elevation[place])
                           patch.elevation[place] = elevation;
                         patch.mask[place] = 1;
                       });
  crop(patch);
  return patch;
}

}  // namespace

ElevationMaps resample_mesh(const Mesh& mesh, const Partition& partition, std::span<const BasePlane> planes,
                            double spacing) {
  assert(spacing > 0 && planes.size() == partition.patches.size());
  assert(partition.patch_of.size() == mesh.triangles.size());
  const BoundingBox box = bounding_box(mesh.positions);
  ElevationMaps maps{spacing, box.diagonal(), box.minimum, std::vector<ElevationPatch>(planes.size())};
  const std::vector<std::vector<std::uint32_t>> triangles = partition.elements_of_patches();
  thin::parallel_ranges(planes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t patch = begin; patch < end; ++patch)
      maps.patches[patch] = resample_patch(mesh, triangles[patch], planes[patch], spacing);
  });
  return maps;
}

double spacing_for_resolution(const Mesh& mesh, const Partition& partition, std::span<const BasePlane> planes,
                              double mu) {
  double projected_area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    projected_area += std::abs(scaled_normal(mesh, mesh.triangles[i]).dot(planes[partition.patch_of[i]].normal)) / 2;
  return mu * std::sqrt(projected_area / static_cast<double>(std::max<std::size_t>(mesh.positions.size(), 1)));
}

}  // namespace emap
