#pragma once

// Connected parts of what carries the same label in an element graph.

#include "libemap/partition/element_graph.h"

namespace emap {

struct Component {
  std::vector<std::uint32_t> elements;  // in breadth-first order from the smallest
  double area = 0;
};

// The connected components of the elements whose label is `label`, by their smallest element.
std::vector<Component> components_of(const ElementGraph& graph, const std::vector<std::uint32_t>& labels,
                                     std::uint32_t label);

// The same for all labels at once: one component for each connected run of equal labels.
std::vector<Component> components_of(const ElementGraph& graph, const std::vector<std::uint32_t>& labels);

}  // namespace emap
