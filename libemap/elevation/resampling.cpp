#include "libemap/elevation/resampling.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d offset = mesh.positions[triangle[i]] - plane.origin;
    corners[i] = {plane.axis_u.dot(offset) / spacing, plane.axis_v.dot(offset) / spacing, plane.normal.dot(offset)};
  }
  return corners;
}

// Rows and columns at the far ends that hold no sample go.
void crop(ElevationPatch& patch) {
  std::uint32_t columns = 0, rows = 0;
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      if (patch.mask[std::size_t{row} * patch.columns + column]) {
        rows = row + 1;
        columns = std::max(columns, column + 1);
      }
  for (std::size_t row = 1; row < rows; ++row) {
    std::copy_n(patch.mask.begin() + static_cast<std::ptrdiff_t>(row * patch.columns), columns,
                patch.mask.begin() + static_cast<std::ptrdiff_t>(row * columns));
    std::copy_n(patch.elevation.begin() + static_cast<std::ptrdiff_t>(row * patch.columns), columns,
                patch.elevation.begin() + static_cast<std::ptrdiff_t>(row * columns));
  }
  patch.columns = columns;
  patch.rows = rows;
  patch.mask.resize(std::size_t{rows} * columns);
  patch.elevation.resize(std::size_t{rows} * columns);
}

ElevationPatch resample_patch(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const BasePlane& plane,
                              double spacing) {
  ElevationPatch patch;
  patch.plane = plane;
  double last_u = -1, last_v = -1;
  for (const std::uint32_t triangle : triangles)
    for (const Eigen::Vector3d& corner : corners_over(plane, spacing, mesh, mesh.triangles[triangle])) {
      last_u = std::max(last_u, corner.x());
      last_v = std::max(last_v, corner.y());
    }
  if (last_u < 0 || last_v < 0) return patch;
  patch.columns = static_cast<std::uint32_t>(last_u + 1e-6) + 1;
  patch.rows = static_cast<std::uint32_t>(last_v + 1e-6) + 1;
  patch.mask.assign(std::size_t{patch.rows} * patch.columns, 0);
  patch.elevation.assign(patch.mask.size(), 0);
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
