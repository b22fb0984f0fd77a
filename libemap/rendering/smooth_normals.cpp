#include "libemap/rendering/smooth_normals.h"

namespace emap {

std::vector<Eigen::Vector3d> smooth_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& corner = mesh.positions[triangle[i]];
      const Eigen::Vector3d first = mesh.positions[triangle[(i + 1) % 3]] - corner;
      const Eigen::Vector3d second = mesh.positions[triangle[(i + 2) % 3]] - corner;
      const double scale = first.squaredNorm() * second.squaredNorm();
      if (scale > 0) normals[triangle[i]] += first.cross(second) / scale;
    }
  for (Eigen::Vector3d& normal : normals) {
    const double length = normal.norm();
    normal = length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
  }
  return normals;
}

}  // namespace emap
