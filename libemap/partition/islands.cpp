#include "libemap/partition/islands.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "libemap/partition/components.h"
#include "libthin/foundation/kd_tree.h"

namespace emap {
namespace {

// The cubes, of side `reach`, in which islands lie and those around: other elements can't be within reach of any.
class Surroundings {
 public:
  explicit Surroundings(double reach) : reach_(reach) {}

  void add(const Eigen::Vector3d& place) {
    const std::array<std::int64_t, 3> cube = cube_of(place);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) cubes_.insert(key_of({cube[0] + x, cube[1] + y, cube[2] + z}));
  }
  bool contains(const Eigen::Vector3d& place) const { return cubes_.contains(key_of(cube_of(place))); }

 private:
  std::array<std::int64_t, 3> cube_of(const Eigen::Vector3d& place) const {
    std::array<std::int64_t, 3> cube;
    for (int axis = 0; axis < 3; ++axis)
      cube[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(place[axis] / reach_));
    return cube;
  }
  // Equal keys of far cubes only make more candidates.
  static std::uint64_t key_of(const std::array<std::int64_t, 3>& cube) {
    std::uint64_t key = 0;
    for (const std::int64_t component : cube)
      key = (key ^ static_cast<std::uint64_t>(component)) * 0x9E3779B97F4A7C15ULL + (key >> 29);
    return key;
  }

  double reach_;
  std::unordered_set<std::uint64_t> cubes_;
};

struct Candidates {
  std::vector<std::uint32_t> elements;
  std::vector<double> coordinates;  // elements x 3
};

std::vector<bool> on_islands(const std::vector<Component>& islands, std::size_t count) {
  std::vector<bool> result(count, false);
  for (const Component& island : islands)
    for (const std::uint32_t element : island.elements) result[element] = true;
  return result;
}

Candidates candidates_near(const ElementGraph& graph, const std::vector<Component>& islands, double reach) {
  const std::vector<bool> is_island = on_islands(islands, graph.size());
  Surroundings surroundings(reach);
  for (const Component& island : islands)
    for (const std::uint32_t element : island.elements) surroundings.add(graph.centres[element]);
  Candidates candidates;
  for (std::uint32_t element = 0; element < graph.size(); ++element) {
    if (is_island[element] || !surroundings.contains(graph.centres[element])) continue;
    candidates.elements.push_back(element);
    for (const double coordinate : graph.centres[element]) candidates.coordinates.push_back(coordinate);
  }
  return candidates;
}

}  // namespace

std::vector<AdjacentPair> island_links(const ElementGraph& graph, std::size_t most_elements, double reach) {
  std::vector<Component> islands = components_of(graph, std::vector<std::uint32_t>(graph.size(), 0));
  std::erase_if(islands, [&](const Component& component) { return component.elements.size() > most_elements; });
  std::vector<AdjacentPair> links;
  const double reach_length =
      reach * std::sqrt(graph.total_area() / static_cast<double>(std::max<std::size_t>(graph.size(), 1)));
  if (islands.empty() || !(reach_length > 0)) return links;
  const Candidates candidates = candidates_near(graph, islands, reach_length);
  const thin::KdTree tree(candidates.coordinates, 3);
  std::vector<thin::Neighbour> found;
  for (const Component& island : islands) {
    double nearest = reach_length * reach_length;
    AdjacentPair link{0, 0, 0};
    for (const std::uint32_t element : island.elements) {
      tree.nearest({graph.centres[element].data(), 3}, 1, found);
      if (found.empty() || !(found[0].distance_squared < nearest)) continue;
      nearest = found[0].distance_squared;
      link = {element, candidates.elements[found[0].index], 0};
    }
    if (link.first != link.second) links.push_back(link);
  }
  return links;
}

void add_links(std::span<const AdjacentPair> links, ElementGraph& graph) {
  std::vector<AdjacentPair> pairs(links.begin(), links.end());
  pairs.reserve(links.size() + graph.adjacencies.size() / 2);
  for (std::uint32_t element = 0; element < graph.size(); ++element)
    for (const Adjacency& side : graph.neighbours(element))
      if (element < side.element) pairs.push_back({element, side.element, side.boundary_length});
  set_adjacency(pairs, graph);
}

}  // namespace emap
