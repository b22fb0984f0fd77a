#pragma once

// Masks that cost less. Where a patch ends is arbitrary to within a sample: its neighbour goes on from there, and gap
// filling joins the two. So samples along the boundary come and go where that saves more bits of the mask's code than
// the surface loses, and patches of a few samples go where gap filling spans them.

#include <cstddef>
#include <vector>

#include "libemap/coding/mask_freedom.h"
#include "libemap/elevation/elevation_map.h"
#include "libemap/partition/partition.h"
#include "libemap/surface/surface.h"
#include "libemap/surface/triangle_tree.h"

namespace emap {

// Losses are counted in bits. That works for all rates: the error that a rate comes with is about as large in spacings
// of the maps that suit it.
struct MaskChoiceOptions {
  MaskFreedomOptions freedom;
  std::ptrdiff_t fewest_samples = 48;            // of a map, below which its boundary stays
  std::ptrdiff_t most_samples_lost = 16;         // of a patch that may go
  double bits_of_patch = 50;                     // that its going saves, to be on the safe side
  double rival_reach = 0.65, bits_of_rival = 3;  // spacings: samples of two patches so near make triangles cross
  double gap_reach = 1.6, bits_of_gap = 10;      // spacings: where a sample is missing, another patch's must be so near
  double hole = 0.4;  // spacings: where gap filling misses the surface by more, masks stay as they are
  int rounds = 8;
};

// maps: resampled from the mesh over this partition; those that lose all their samples come back without rows. Samples
// come and go within a map's columns and rows; new ones lie on the mesh. The tree is the mesh's. Deterministic for any
// number of threads.
void choose_cheaper_masks(const Mesh& mesh, const Partition& partition, const TriangleTree& tree, ElevationMaps& maps,
                          const MaskChoiceOptions& options = {});

}  // namespace emap
