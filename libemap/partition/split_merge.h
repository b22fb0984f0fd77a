#pragma once

// Split-merge partitioning (thesis, 3.3.2, after Pauly and Gross 2001): clusters are split at their centre of mass,
// across the largest principal axis, until their normals fit into a narrow cone; then neighbours are merged as long as
// the wider cone of the aperture holds them (partition/patch_merging.h).

#include "libemap/partition/element_graph.h"
#include "libemap/partition/footprints.h"
#include "libemap/partition/rough_partition.h"

namespace emap {

struct SplitMergeOptions {
  double split_degrees = 40;     // alpha
  double aperture_degrees = 80;  // beta
  bool strict = true;
};

RoughPartition split_merge_partition(const ElementGraph& graph, const Footprints& footprints,
                                     const SplitMergeOptions& options);

// The clusters of the splitting phase alone: connected, each within `split_degrees`.
RoughPartition split_clusters(const ElementGraph& graph, double split_degrees);

}  // namespace emap
