#pragma once

// From a rough partition of groups to the partition of the single elements: strict, complete, and connected.

#include "libemap/partition/coarsening.h"
#include "libemap/partition/flooding.h"
#include "libemap/partition/lloyd_partition.h"
#include "libemap/partition/partition.h"

namespace emap {

struct FinishingOptions {
  double aperture_degrees = 80;
  double scrap_error = 0;  // model units: root mean square error over the whole surface that scraps may add
  bool optimise_boundaries = true;
};

// Planes are those of the narrowest cones around the rough patches. What no patch can take goes to patches of its own;
// scraps of a few elements that lie within the footprints' height tolerance of a patch beside them join it whatever
// their normals.
Partition finish_partition(const ElementGraph& graph, const Footprints& footprints, const Coarsening& coarsening,
                           const RoughPartition& rough, const FinishingOptions& options);

}  // namespace emap
