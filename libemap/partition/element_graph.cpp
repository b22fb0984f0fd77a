#include "libemap/partition/element_graph.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::size_t kGrain = 4096;

std::vector<AdjacentPair> edge_sharing_pairs(const Mesh& mesh) {
  std::vector<AdjacentPair> pairs;
  for (const EdgePair& pair : edge_pairs(mesh))
    pairs.push_back({pair.first_triangle, pair.second_triangle,
                     static_cast<float>((mesh.positions[pair.vertex] - mesh.positions[pair.other_vertex]).norm())});
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

void smooth_normals_within(int rounds, double most_degrees, ElementGraph& graph) {
  if (rounds <= 0) return;
  const std::vector<Eigen::Vector3d> before = graph.normals;
  smooth_normals(rounds, graph);
  const double most = most_degrees * std::numbers::pi / 180, least_cosine = std::cos(most);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d aside = graph.normals[i] - before[i].dot(graph.normals[i]) * before[i];
    if (before[i].isZero(0) || before[i].dot(graph.normals[i]) >= least_cosine) continue;
    const double length = aside.norm();
    graph.normals[i] =
        length > 0 ? (least_cosine * before[i] + std::sin(most) / length * aside).normalized() : before[i];
  }
}

}  // namespace emap
