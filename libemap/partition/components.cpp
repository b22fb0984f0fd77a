#include "libemap/partition/components.h"

namespace emap {
namespace {

template <class Wanted>
std::vector<Component> wanted_components(const ElementGraph& graph, const std::vector<std::uint32_t>& labels,
                                         const Wanted& wanted) {
  std::vector<Component> components;
  std::vector<bool> visited(graph.size(), false);
  for (std::uint32_t start = 0; start < graph.size(); ++start) {
    if (visited[start] || !wanted(labels[start])) continue;
    visited[start] = true;
    Component component{{start}, 0};
    for (std::size_t next = 0; next < component.elements.size(); ++next) {
      const std::uint32_t element = component.elements[next];
      component.area += graph.areas[element];
      for (const Adjacency& neighbour : graph.neighbours(element)) {
        if (visited[neighbour.element] || labels[neighbour.element] != labels[start]) continue;
        visited[neighbour.element] = true;
        component.elements.push_back(neighbour.element);
      }
    }
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace

std::vector<Component> components_of(const ElementGraph& graph, const std::vector<std::uint32_t>& labels,
                                     std::uint32_t label) {
  return wanted_components(graph, labels, [label](std::uint32_t other) { return other == label; });
}

std::vector<Component> components_of(const ElementGraph& graph, const std::vector<std::uint32_t>& labels) {
  return wanted_components(graph, labels, [](std::uint32_t) { return true; });
}

}  // namespace emap
