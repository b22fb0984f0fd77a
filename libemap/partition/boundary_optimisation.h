#pragma once

// Shorter patch boundaries (thesis, 3.3.2): elements, and pairs of them, change over to the patch beside them while
// that shortens the total length of all boundaries.

#include "libemap/partition/element_graph.h"
#include "libemap/partition/sheet_map.h"

namespace emap {

// Longest gain first. An element moves only where its new patch's aperture and sheet map allow it and its old patch
// stays connected around it. Returns by how much the boundaries became shorter.
double optimise_boundaries(const ElementGraph& graph, double aperture_cosine, SheetMap& sheets,
                           std::vector<std::uint32_t>& patch_of);

// Total length of the boundaries between patches.
double boundary_length(const ElementGraph& graph, const std::vector<std::uint32_t>& patch_of);

}  // namespace emap
