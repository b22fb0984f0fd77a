#pragma once

// Small parts of a surface that touch nothing else, as scanned meshes have hundreds: links to what lies next to them,
// so that they can join its patch.

#include "libemap/partition/element_graph.h"

namespace emap {

// Links (of boundary length 0) from each connected component of at most `most_elements` elements to the nearest element
// of a larger one, where one is within `reach` mean element sizes. What is left unlinked is far from everything.
std::vector<AdjacentPair> island_links(const ElementGraph& graph, std::size_t most_elements, double reach);

// The graph's adjacency with these pairs added.
void add_links(std::span<const AdjacentPair> links, ElementGraph& graph);

}  // namespace emap
