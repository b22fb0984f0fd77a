#pragma once

// What a map's mask may gain or lose along its boundary, and what the surface loses by that.

#include <cstdint>
#include <vector>

#include "libemap/elevation/elevation_map.h"
#include "libemap/surface/surface.h"
#include "libemap/surface/triangle_tree.h"

namespace emap {

// A sample at the boundary of its map that may be there or not.
struct FreeSample {
  std::uint32_t row, column;
  double elevation;                        // of the surface over it, model units
  Eigen::Vector3d position;                // of that
  double bits_if_absent, bits_if_present;  // what the surface loses either way, as bits would mend it elsewhere
};

struct MaskFreedomOptions {
  double farthest_dropped = 0.8, farthest_added = 0.5;  // samples from the patch's boundary
  double bits_at_half = 2;   // of a boundary moved by half a sample; by more or less, with the square
  double bits_of_bend = 40;  // of a sample that lies a whole spacing beside where the surface would be without it;
                             // nearer, with the square
};

// triangles: those of the mesh that the map was resampled from. The tree is the mesh's.
std::vector<FreeSample> free_samples(const Mesh& mesh, const std::vector<std::uint32_t>& triangles,
                                     const TriangleTree& tree, const ElevationPatch& patch, double spacing,
                                     const MaskFreedomOptions& options = {});

}  // namespace emap
