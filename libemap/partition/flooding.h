#pragma once

// Cluster flooding (thesis, 3.3.2): patches grow from their seeds over neighbouring elements, always by the element
// whose normal is nearest to that of the plane of a patch beside it. O(n log n).

#include <cstdint>
#include <span>
#include <vector>

#include "libemap/partition/element_graph.h"
#include "libemap/partition/rough_partition.h"
#include "libemap/partition/sheet_map.h"

namespace emap {

struct FloodingRules {
  double aperture_cosine = 0;  // no element whose normal is farther from the plane's than this
  // Elements that, where they are taken at all, must go to a patch, and before all others; kNoPatch for those free to
  // choose. Empty: all are free.
  std::span<const std::uint32_t> fixed = {};
  double leniency = 1;  // of the sheet map
};

// Cosine of the widest angle between the element's normals and the direction; 1 where it has none.
double least_cosine(const ElementGraph& graph, std::uint32_t element, const Eigen::Vector3d& normal);

// Floods from the elements that have a patch in `patch_of` already over those that have none (kNoPatch). Patches are
// those of the sheet map, which refuses second sheets; it must hold already what has a patch. What no patch can take
// stays at kNoPatch. The result depends on the graph and the numbers of the elements alone.
void flood(const ElementGraph& graph, const FloodingRules& rules, SheetMap& sheets,
           std::vector<std::uint32_t>& patch_of);

}  // namespace emap
