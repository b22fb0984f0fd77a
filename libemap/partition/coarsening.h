#pragma once

// Groups of neighbouring elements with like normals, as elements of a smaller graph: the methods iterate on it and look
// at the single elements only in the end.

#include "libemap/partition/element_graph.h"

namespace emap {

struct Coarsening {
  ElementGraph graph;
  std::vector<std::uint32_t> group_of;  // one for each fine element
};

// Groups of at most `group_size`, connected, grown in breadth from the first element that is in none yet, over elements
// whose normals are within `spread_degrees` of that first one's. O(n).
Coarsening coarsen(const ElementGraph& fine, std::size_t group_size, double spread_degrees);

}  // namespace emap
