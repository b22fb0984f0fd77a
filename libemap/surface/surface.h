#pragma once

// The two kinds of surface that libemap takes: a triangle mesh, and a set of points whose surface is implied by them
// (surface/mls_surface.h).

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace emap {

// Model units throughout. Triangles are counter-clockwise seen from outside; any mesh is allowed: open, non-manifold,
// with vertices that no triangle uses, with triangles of no area.
struct Mesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into positions
};

struct PointSet {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;  // of unit length, one for each position; or empty
};

}  // namespace emap
