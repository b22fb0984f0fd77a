#pragma once

// A mesh or points as they come, quantised as the maps are (thesis, table 5.2): what the maps are compared with.

#include <array>
#include <cstdint>
#include <vector>

#include "libemap/rendering/polar_normal.h"
#include "libemap/surface/bounding_box.h"
#include "libemap/surface/model_file.h"

namespace emap {

struct PlainVertex {
  std::array<std::uint16_t, 3> position;  // 0 to 65535 along the sides of the box
  PolarNormal normal;
};
static_assert(sizeof(PlainVertex) == 10);

struct PlainGeometry {
  Eigen::Matrix4d model_from_grid = Eigen::Matrix4d::Identity();  // of positions: centred, a diagonal of 1
  std::vector<PlainVertex> vertices;
  std::vector<float> radii;              // of splats, diagonals; empty where a mesh is to be drawn
  std::vector<std::uint32_t> triangles;  // three indices each; empty where splats are
  double spacing = 0;                    // the median radius times the square root of 2: as far apart as samples are
  bool closed = false;                   // whether no one can look inside: for the caller to say

  // Indices count 4 bytes, 2 where they fit.
  std::size_t bytes() const;
};

// REQUIRES: triangles
PlainGeometry plain_mesh_geometry(const Mesh& mesh, const BoundingBox& box);

// Radii by the local Delaunay rule. REQUIRES: points with normals
PlainGeometry plain_splat_geometry(const PointSet& points, const BoundingBox& box);

}  // namespace emap
