#include "libemap/partition/element_graph.h"
#include "libemap/surface/point_neighbours.h"

namespace emap {
namespace {

constexpr std::size_t kSpacingNeighbours = 12;

}  // namespace

ElementGraph point_graph(const PointSet& points, int neighbour_count, int smoothing_rounds) {
  const thin::KdTree tree = tree_of(points.positions);
  const auto count = static_cast<std::size_t>(neighbour_count);
  const PointNeighbours neighbours(points.positions, tree, std::max(count, kSpacingNeighbours));
  ElementGraph graph;
  graph.centres = points.positions;
  graph.normals = points.normals;
  graph.areas.resize(points.positions.size());
  for (std::uint32_t point = 0; point < graph.areas.size(); ++point)
    graph.areas[point] = neighbours.spacing(point) * neighbours.spacing(point);
  // Points have no sides; all that neighbours share is worth the same.
  const auto pairs = neighbour_pairs(neighbours, count);
  std::vector<AdjacentPair> adjacent;
  adjacent.reserve(pairs.size());
  for (const auto& [a, b] : pairs) adjacent.push_back({a, b, 1});
  set_adjacency(adjacent, graph);
  smooth_normals(smoothing_rounds, graph);
  return graph;
}

}  // namespace emap
