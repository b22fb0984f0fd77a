#pragma once

// Points spread evenly over a mesh, for errors that are integrals over its surface.

#include "libemap/surface/surface.h"

namespace emap {

// `count` points, area-weighted and stratified: one in each of `count` equal shares of the area in the order of the
// triangles. The same points for the same mesh, count and seed, on any machine. None where the mesh has no area.
std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed);

// Points that each stand for a part of the area.
struct WeightedSamples {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> areas;  // one for each position; together the mesh's
};

// About `count` points as above, but no small part of the surface goes without one: the triangles before `first_single`
// are taken in at most `count` runs of equally many neighbours in their order, those from there on one by one, and each
// of these runs gets a point at least, wherever it has an area. At most 2 * count + the number of single ones.
WeightedSamples sample_every_part(const Mesh& mesh, std::size_t count, std::size_t first_single, std::uint64_t seed);

}  // namespace emap
