#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libemap/surface/surface.h"

namespace emap {

// Whether two triangles over the same vertices have a point in common other than the vertices and edges that they
// share. Decided exactly for the coordinates as they are.
bool triangles_cross(const std::vector<Eigen::Vector3d>& positions, const std::array<std::uint32_t, 3>& first,
                     const std::array<std::uint32_t, 3>& second);

}  // namespace emap
