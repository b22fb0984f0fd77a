#pragma once

// Generalised Lloyd partitioning (thesis, 3.3.2, after Cohen-Steiner et al. 2004): flooding from seeds and refitting of
// the planes in turn; a new seed wherever something is left that no patch can take.

#include "libemap/partition/element_graph.h"
#include "libemap/partition/footprints.h"
#include "libemap/partition/rough_partition.h"

namespace emap {

struct LloydOptions {
  double aperture_degrees = 80;
  int least_patches = 1;  // seeds are added until there are as many, even where fewer would do
  int rounds = 60;        // of flooding until convergence and seeding
};

RoughPartition lloyd_partition(const ElementGraph& graph, const Footprints& footprints, const LloydOptions& options);

}  // namespace emap
