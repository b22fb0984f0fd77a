#pragma once

// Generalised Lloyd partitioning (thesis, 3.3.2, after Cohen-Steiner et al. 2004): flooding from seeds and refitting of
// the planes in turn; a new seed wherever something is left that no patch can take.

#include "libemap/partition/element_graph.h"
#include "libemap/partition/footprints.h"

namespace emap {

struct LloydOptions {
  double aperture_degrees = 80;
  int least_patches = 1;  // seeds are added until there are as many, even where fewer would do
  int rounds = 60;        // of flooding until convergence and seeding
};

// Seeds, planes and assignment of a partition that may leave elements out.
struct RoughPartition {
  std::vector<std::uint32_t> patch_of;   // kNoPatch where no patch could take an element
  std::vector<Eigen::Vector3d> normals;  // of the patches' planes
  std::vector<std::uint32_t> seeds;      // one element of each patch
};

RoughPartition lloyd_partition(const ElementGraph& graph, const Footprints& footprints, const LloydOptions& options);

}  // namespace emap
