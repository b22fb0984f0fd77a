#include "libemap/surface/mesh_normals.h"

namespace emap {

std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d normal = scaled_normal(mesh, triangle);
    for (const std::uint32_t vertex : triangle) normals[vertex] += normal;
  }
  for (Eigen::Vector3d& normal : normals)
    if (const double length = normal.norm(); length > 0) normal /= length;
  return normals;
}

double surface_area(const Mesh& mesh) {
  double area = 0;
  for (const auto& triangle : mesh.triangles) area += scaled_normal(mesh, triangle).norm() / 2;
  return area;
}

}  // namespace emap
