#pragma once

// The icosahedral grid of the GME (Majewski et al. 2002): near-uniform evaluation points on the globe.

#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

constexpr int kMaximumGmeLevel = 9;

constexpr std::size_t gme_vertex_count(int level) {
  return 10 * (std::size_t{1} << (2 * level)) + 2;
}

// All 10 * 4^level + 2 vertices, on the WGS84 ellipsoid, km: the icosahedron with a vertex at each pole, each edge
// halved `level` times and every midpoint projected on the unit sphere. The direction of a vertex is its geocentric
// direction. The vertices of a coarser level come first, so that level l is a prefix of level l + 1.
// O(4^level) time and memory. REQUIRES: 0 <= level <= kMaximumGmeLevel
std::vector<Vector3> gme_grid(int level);

}  // namespace thin
