#pragma once

// Elevation maps made ready to be drawn: a normal for every sample, the same on both sides of a seam, and rims of
// samples taken from the neighbouring patches, so that patches overlap a little (thesis, 5.2.2 and figure 5.6).

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "libemap/elevation/elevation_map.h"
#include "libemap/elevation/gap_filling.h"

namespace emap {

constexpr int kMostRims = 2;

struct DressedPatch {
  // Grown by `rims` samples on all four sides; the mask is 1 where there is a sample of any ring.
  ElevationPatch map;
  std::vector<std::uint8_t> ring;       // as the mask: 0 = nothing, 1 = the map's own, 2 and 3 = first and second rim
  std::vector<Eigen::Vector3f> normal;  // along axis_u, axis_v and the plane's normal; of unit length
};

// surface: closed_mesh(maps). Rims are where its triangles around the patch lie over the patch's grid, facing as the
// plane does; where the surface turns away at once there is none. Deterministic for any number of threads.
// REQUIRES: 0 <= rims <= kMostRims
std::vector<DressedPatch> dressed_patches(const ElevationMaps& maps, const Mesh& surface, int rims);

}  // namespace emap
