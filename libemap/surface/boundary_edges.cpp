#include "libemap/surface/boundary_edges.h"

#include <algorithm>
#include <numeric>

namespace emap {
namespace {

// A triangle's side, seen from the smaller of its two vertices.
struct Side {
  std::uint32_t larger_vertex, triangle;
};

// All sides by their smaller vertex: first[v] .. first[v + 1] in `sides`, by larger vertex, then triangle.
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
  for (std::size_t vertex = 0; vertex + 1 < result.first.size(); ++vertex)
    std::sort(result.sides.begin() + result.first[vertex], result.sides.begin() + result.first[vertex + 1],
              [](const Side& a, const Side& b) {
                return a.larger_vertex != b.larger_vertex ? a.larger_vertex < b.larger_vertex : a.triangle < b.triangle;
              });
  return result;
}

BoundaryEdge directed(const Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t triangle) {
  const auto& corners = mesh.triangles[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
    if ((from == a && to == b) || (from == b && to == a)) return {from, to, corners[(i + 2) % 3]};
  }
  return {a, b, a};
}

}  // namespace

std::vector<BoundaryEdge> boundary_edges(const Mesh& mesh) {
  const SidesByVertex by_vertex = sides_by_vertex(mesh);
  std::vector<BoundaryEdge> edges;
  for (std::uint32_t vertex = 0; vertex + 1 < by_vertex.first.size(); ++vertex)
    for (std::uint32_t i = by_vertex.first[vertex]; i < by_vertex.first[vertex + 1]; ++i) {
      const auto same = [&](std::uint32_t j) {
        return j >= by_vertex.first[vertex] && j < by_vertex.first[vertex + 1] &&
               by_vertex.sides[j].larger_vertex == by_vertex.sides[i].larger_vertex;
      };
      if (!same(i + 1) && !(i > 0 && same(i - 1)))
        edges.push_back(directed(mesh, vertex, by_vertex.sides[i].larger_vertex, by_vertex.sides[i].triangle));
    }
  return edges;
}

std::vector<EdgePair> edge_pairs(const Mesh& mesh) {
  const SidesByVertex by_vertex = sides_by_vertex(mesh);
  std::vector<EdgePair> pairs;
  pairs.reserve(by_vertex.sides.size() / 2);
  for (std::uint32_t vertex = 0; vertex + 1 < by_vertex.first.size(); ++vertex)
    for (std::uint32_t i = by_vertex.first[vertex] + 1; i < by_vertex.first[vertex + 1]; ++i) {
      const Side &side = by_vertex.sides[i - 1], &next = by_vertex.sides[i];
      if (side.larger_vertex == next.larger_vertex && side.triangle != next.triangle)
        pairs.push_back({side.triangle, next.triangle, vertex, side.larger_vertex});
    }
  return pairs;
}

}  // namespace emap
