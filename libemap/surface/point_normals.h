#pragma once

// Normals of a point set (thesis, 2.2.3): planes fitted to the neighbours, oriented over a spanning tree after Hoppe et
// al. 1992.

#include "libemap/surface/point_neighbours.h"
#include "libemap/surface/surface.h"

namespace emap {

constexpr std::size_t kNormalNeighbours = 12;

// Unit normals, not oriented: each the normal of the plane of least squares through the point and its neighbours,
// weighted by exp(-s²/h²), h the mean distance. Where they are at one place: the z-axis.
std::vector<Eigen::Vector3d> fitted_normals(const std::vector<Eigen::Vector3d>& positions,
                                            const PointNeighbours& neighbours);

// Flips normals so that neighbouring ones point the same way, over the spanning tree on which they turn least (weights
// 1 - |n·n'|, ties to the shorter); in each connected part the point with the largest z points up.
void orient_normals(const std::vector<Eigen::Vector3d>& positions, const PointNeighbours& neighbours,
                    std::vector<Eigen::Vector3d>& normals);

// Fits and orients normals where the set has none.
void ensure_normals(PointSet& points);

}  // namespace emap
