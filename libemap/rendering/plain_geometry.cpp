#include "libemap/rendering/plain_geometry.h"

#include <algorithm>
#include <cmath>

#include "libemap/rendering/smooth_normals.h"
#include "libemap/surface/point_radii.h"

namespace emap {
namespace {

PlainGeometry quantised(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& normals,
                        const BoundingBox& box) {
  PlainGeometry geometry;
  const double scale = 1 / box.diagonal();
  const Eigen::Vector3d sides = box.maximum - box.minimum;
  for (int axis = 0; axis < 3; ++axis) geometry.model_from_grid(axis, axis) = sides[axis] * scale / 65535;
  geometry.model_from_grid.col(3).head<3>() = -0.5 * scale * sides;
  geometry.vertices.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    PlainVertex vertex{{}, polar_normal(normals[i])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      const double part = sides[a] > 0 ? (positions[i][a] - box.minimum[a]) / sides[a] : 0;
      vertex.position[axis] = static_cast<std::uint16_t>(std::lround(65535 * std::clamp(part, 0.0, 1.0)));
    }
    geometry.vertices.push_back(vertex);
  }
  return geometry;
}

}  // namespace

std::size_t PlainGeometry::bytes() const {
  return vertices.size() * sizeof(PlainVertex) + 4 * radii.size() +
         (vertices.size() <= 65536 ? 2 : 4) * triangles.size();
}

PlainGeometry plain_mesh_geometry(const Mesh& mesh, const BoundingBox& box) {
  PlainGeometry geometry = quantised(mesh.positions, smooth_normals(mesh), box);
  geometry.triangles.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    geometry.triangles.insert(geometry.triangles.end(), triangle.begin(), triangle.end());
  return geometry;
}

PlainGeometry plain_splat_geometry(const PointSet& points, const BoundingBox& box) {
  PlainGeometry geometry = quantised(points.positions, points.normals, box);
  std::vector<double> radii = delaunay_radii(points);
  for (const double radius : radii) geometry.radii.push_back(static_cast<float>(radius / box.diagonal()));
  if (radii.empty()) return geometry;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  geometry.spacing = std::sqrt(2.0) * *middle / box.diagonal();
  return geometry;
}

}  // namespace emap
