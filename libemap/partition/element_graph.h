#pragma once

// What the partitioning methods see of a surface: elements (triangles, points, or small groups of them) with a place, a
// normal and an area, and which of them touch along how long a boundary. Meshes and point sets look alike here.

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "libemap/surface/surface.h"

namespace emap {

struct Adjacency {
  std::uint32_t element;
  float boundary_length;  // that the two share
};

struct ElementGraph {
  std::vector<Eigen::Vector3d> centres;
  // Of unit length and smoothed, so that noise does not decide which patch an element fits. Zero where the surface has
  // no direction there: such an element fits every patch.
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> areas;
  std::vector<double> spread_cosines;          // of the widest angle of the group's normals to `normals`; empty: all 1
  std::vector<std::uint32_t> first_adjacency;  // size() + 1; of each element in `adjacencies`
  std::vector<Adjacency> adjacencies;          // symmetric

  std::size_t size() const { return centres.size(); }
  std::span<const Adjacency> neighbours(std::uint32_t element) const {
    return std::span(adjacencies)
        .subspan(first_adjacency[element], first_adjacency[element + 1] - first_adjacency[element]);
  }
  double total_area() const;
};

// Triangles as elements, neighbours where they share an edge (all those at a non-manifold edge).
// smoothing_rounds: how often each normal is replaced by the area-weighted mean of its own and its neighbours'.
ElementGraph mesh_graph(const Mesh& mesh, int smoothing_rounds);

// Points as elements, neighbours where one is among the `neighbour_count` nearest of the other. An area is that of a
// disc that reaches half-way to them. REQUIRES: a normal for each point
ElementGraph point_graph(const PointSet& points, int neighbour_count, int smoothing_rounds);

// Helper of the makers: fills the adjacency from pairs, each given once.
struct AdjacentPair {
  std::uint32_t first, second;
  float boundary_length;
};
void set_adjacency(std::span<const AdjacentPair> pairs, ElementGraph& graph);

void smooth_normals(int rounds, ElementGraph& graph);

// The same, but each stays within so many degrees of what it was.
void smooth_normals_within(int rounds, double most_degrees, ElementGraph& graph);

}  // namespace emap
