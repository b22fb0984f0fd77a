#pragma once

// Merging of neighbouring patches (thesis, 3.3.2): always the two by whose union J grows least, as long as there are
// two whose union is still a height field within the aperture.

#include "libemap/partition/element_graph.h"
#include "libemap/partition/footprints.h"
#include "libemap/partition/rough_partition.h"

namespace emap {

struct MergingOptions {
  double aperture_degrees = 80;
  std::size_t least_patches = 1;  // stops there
  bool strict = true;             // a union must be one sheet over its plane
};

// The planes of merged patches are those of the narrowest cones around them.
RoughPartition merge_patches(const ElementGraph& graph, const Footprints& footprints, RoughPartition rough,
                             const MergingOptions& options);

}  // namespace emap
