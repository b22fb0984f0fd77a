#include "libemap/partition/element_graph.h"

#include <algorithm>
#include <numeric>

#include "libemap/surface/mesh_normals.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::size_t kGrain = 4096;

// A triangle's side, seen from the smaller of its two vertices.
struct Side {
  std::uint32_t larger_vertex, triangle;
};

// All sides by their smaller vertex: first[v] .. first[v + 1] in `sides`.
struct SidesByVertex {
  std::vector<std::uint32_t> first;
  std::vector<Side> sides;
};

template <class Visitor>
void visit_sides(const Mesh& mesh, const Visitor& visit) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
      if (a != b) visit(std::min(a, b), std::max(a, b), t);
    }
  }
}

SidesByVertex sides_by_vertex(const Mesh& mesh) {
  SidesByVertex result;
  result.first.assign(mesh.positions.size() + 1, 0);
  visit_sides(mesh, [&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++result.first[a + 1]; });
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.sides.resize(result.first.back());
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  visit_sides(mesh, [&](std::uint32_t a, std::uint32_t b, std::uint32_t t) { result.sides[next[a]++] = {b, t}; });
  return result;
}

std::vector<AdjacentPair> edge_sharing_pairs(const Mesh& mesh) {
  SidesByVertex by_vertex = sides_by_vertex(mesh);
  std::vector<AdjacentPair> pairs;
  pairs.reserve(by_vertex.sides.size() / 2);
  for (std::uint32_t vertex = 0; vertex + 1 < by_vertex.first.size(); ++vertex) {
    const auto begin = by_vertex.sides.begin() + by_vertex.first[vertex];
    const auto end = by_vertex.sides.begin() + by_vertex.first[vertex + 1];
    std::sort(begin, end, [](const Side& a, const Side& b) {
      return a.larger_vertex != b.larger_vertex ? a.larger_vertex < b.larger_vertex : a.triangle < b.triangle;
    });
    // Triangles at one edge are chained: each is the neighbour of the next.
    for (auto side = begin; side != end && side + 1 != end; ++side)
      if (side->larger_vertex == (side + 1)->larger_vertex && side->triangle != (side + 1)->triangle)
        pairs.push_back({side->triangle, (side + 1)->triangle,
                         static_cast<float>((mesh.positions[vertex] - mesh.positions[side->larger_vertex]).norm())});
  }
  return pairs;
}

}  // namespace

double ElementGraph::total_area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

void set_adjacency(std::span<const AdjacentPair> pairs, ElementGraph& graph) {
  graph.first_adjacency.assign(graph.size() + 1, 0);
  for (const AdjacentPair& pair : pairs) {
    ++graph.first_adjacency[pair.first + 1];
    ++graph.first_adjacency[pair.second + 1];
  }
  std::partial_sum(graph.first_adjacency.begin(), graph.first_adjacency.end(), graph.first_adjacency.begin());
  graph.adjacencies.resize(graph.first_adjacency.back());
  std::vector<std::uint32_t> next(graph.first_adjacency.begin(), graph.first_adjacency.end() - 1);
  for (const AdjacentPair& pair : pairs) {
    graph.adjacencies[next[pair.first]++] = {pair.second, pair.boundary_length};
    graph.adjacencies[next[pair.second]++] = {pair.first, pair.boundary_length};
  }
}

void smooth_normals(int rounds, ElementGraph& graph) {
  std::vector<Eigen::Vector3d> smoothed(graph.size());
  for (int round = 0; round < rounds; ++round) {
    thin::parallel_ranges(graph.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (auto element = static_cast<std::uint32_t>(begin); element < end; ++element) {
        Eigen::Vector3d sum = graph.areas[element] * graph.normals[element];
        for (const Adjacency& neighbour : graph.neighbours(element))
          sum += graph.areas[neighbour.element] * graph.normals[neighbour.element];
        const double length = sum.norm();
        smoothed[element] = length > 0 ? Eigen::Vector3d(sum / length) : graph.normals[element];
      }
    });
    graph.normals.swap(smoothed);
  }
}

ElementGraph mesh_graph(const Mesh& mesh, int smoothing_rounds) {
  const std::size_t count = mesh.triangles.size();
  ElementGraph graph;
  graph.centres.resize(count);
  graph.normals.resize(count);
  graph.areas.resize(count);
  thin::parallel_ranges(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& triangle = mesh.triangles[i];
      const Eigen::Vector3d normal = scaled_normal(mesh, triangle);
      const double length = normal.norm();
      graph.centres[i] = (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) / 3;
      graph.areas[i] = length / 2;
      graph.normals[i] = length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
    }
  });
  set_adjacency(edge_sharing_pairs(mesh), graph);
  smooth_normals(smoothing_rounds, graph);
  return graph;
}

}  // namespace emap
