#pragma once

// Normals of a mesh: constant in triangles, area-weighted means at vertices (thesis, 2.1).

#include "libemap/surface/surface.h"

namespace emap {

// The normal times twice the area.
inline Eigen::Vector3d scaled_normal(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d& corner = mesh.positions[triangle[0]];
  return (mesh.positions[triangle[1]] - corner).cross(mesh.positions[triangle[2]] - corner);
}

// Of unit length; zero where a vertex has no triangle with an area around it.
std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh);

double surface_area(const Mesh& mesh);

}  // namespace emap
