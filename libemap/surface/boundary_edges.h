#pragma once

// Edges of a mesh by their triangles.

#include "libemap/surface/surface.h"

namespace emap {

struct BoundaryEdge {
  std::uint32_t from, to;  // in the direction of its only triangle
  std::uint32_t opposite;  // that triangle's third vertex
};

// The edges that bound one triangle only, by their smaller vertex. O(n).
std::vector<BoundaryEdge> boundary_edges(const Mesh& mesh);

struct EdgePair {
  std::uint32_t first_triangle, second_triangle;
  std::uint32_t vertex, other_vertex;
};

// Every two triangles that share an edge, once; of several at a non-manifold edge each with the next. O(n).
std::vector<EdgePair> edge_pairs(const Mesh& mesh);

}  // namespace emap
