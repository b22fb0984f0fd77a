#pragma once

// Points spread evenly over a mesh, for errors that are integrals over its surface.

#include "libemap/surface/surface.h"

namespace emap {

// `count` points, area-weighted and stratified: one in each of `count` equal shares of the area in the order of the
// triangles. The same points for the same mesh, count and seed, on any machine. None where the mesh has no area.
std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed);

}  // namespace emap
