#include "libemap/surface/mesh_repair.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"

namespace emap {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// For each vertex the first one at its place.
std::vector<std::uint32_t> first_at_same_place(const std::vector<Eigen::Vector3d>& positions) {
  std::vector<std::uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Eigen::Vector3d &p = positions[a], &q = positions[b];
    return std::tuple(p.x(), p.y(), p.z(), a) < std::tuple(q.x(), q.y(), q.z(), b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

bool has_side(const std::array<std::uint32_t, 3>& triangle, std::uint32_t from, std::uint32_t to) {
  for (std::size_t corner = 0; corner < 3; ++corner)
    if (triangle[corner] == from && triangle[(corner + 1) % 3] == to) return true;
  return false;
}

struct Neighbour {
  std::uint32_t triangle;
  bool same_way_round;
};

// Of each triangle those beside it at edges that only the two share: first[t] .. first[t + 1].
struct Neighbourhood {
  std::vector<std::uint32_t> first;
  std::vector<Neighbour> neighbours;
};

Neighbourhood neighbourhood(const Mesh& mesh) {
  const std::vector<EdgePair> pairs = edge_pairs(mesh);  // by their edges
  // More than one pair at the same edge: more than two triangles, among which there is no pairing.
  const auto same_edge = [&](std::size_t a, std::size_t b) {
    return b < pairs.size() && pairs[a].vertex == pairs[b].vertex && pairs[a].other_vertex == pairs[b].other_vertex;
  };
  Neighbourhood result;
  result.first.assign(mesh.triangles.size() + 1, 0);
  std::vector<EdgePair> single;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!same_edge(i, i + 1) && !(i > 0 && same_edge(i, i - 1))) single.push_back(pairs[i]);
  for (const EdgePair& pair : single) {
    ++result.first[pair.first_triangle + 1];
    ++result.first[pair.second_triangle + 1];
  }
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.neighbours.resize(result.first.back());
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  for (const EdgePair& pair : single) {
    const bool same = has_side(mesh.triangles[pair.first_triangle], pair.vertex, pair.other_vertex) !=
                      has_side(mesh.triangles[pair.second_triangle], pair.vertex, pair.other_vertex);
    result.neighbours[next[pair.first_triangle]++] = {pair.second_triangle, same};
    result.neighbours[next[pair.second_triangle]++] = {pair.first_triangle, same};
  }
  return result;
}

}  // namespace

Mesh weld_vertices(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_same_place(mesh.positions);
  Mesh result;
  result.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
  for (const auto& triangle : mesh.triangles) {
    const std::array<std::uint32_t, 3> corners = {first[triangle[0]], first[triangle[1]], first[triangle[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    result.triangles.push_back(corners);
    for (const std::uint32_t vertex : corners) number[vertex] = 0;
  }
  for (std::size_t vertex = 0; vertex < number.size(); ++vertex) {
    if (number[vertex] == kNone) continue;
    number[vertex] = static_cast<std::uint32_t>(result.positions.size());
    result.positions.push_back(mesh.positions[vertex]);
  }
  for (auto& triangle : result.triangles)
    for (std::uint32_t& vertex : triangle) vertex = number[vertex];
  return result;
}

void orient_consistently(Mesh& mesh) {
  const Neighbourhood around = neighbourhood(mesh);
  const bool is_consistent = std::all_of(around.neighbours.begin(), around.neighbours.end(),
                                         [](const Neighbour& neighbour) { return neighbour.same_way_round; });
  if (is_consistent) return;
  std::vector<std::uint8_t> seen(mesh.triangles.size(), 0), turned(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> part;
  for (std::uint32_t start = 0; start < mesh.triangles.size(); ++start) {
    if (seen[start]) continue;
    part.assign(1, start);
    seen[start] = 1;
    double area_turned = 0, area = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const std::uint32_t triangle = part[next];
      const double own = scaled_normal(mesh, mesh.triangles[triangle]).norm();
      area += own;
      if (turned[triangle]) area_turned += own;
      for (std::uint32_t i = around.first[triangle]; i < around.first[triangle + 1]; ++i) {
        const Neighbour& neighbour = around.neighbours[i];
        if (seen[neighbour.triangle]) continue;
        seen[neighbour.triangle] = 1;
        turned[neighbour.triangle] = turned[triangle] != (neighbour.same_way_round ? 0 : 1);
        part.push_back(neighbour.triangle);
      }
    }
    const bool turns_others = area_turned > area / 2;
    for (const std::uint32_t triangle : part)
      if ((turned[triangle] != 0) != turns_others) std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
  }
}

}  // namespace emap
