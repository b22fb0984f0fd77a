#pragma once

// Radii of discs that cover a point-sampled surface without holes (thesis, 2.2.3).

#include "libemap/surface/surface.h"

namespace emap {

// Of each point the longest edge at it in the Delaunay triangulation of its neighbours, projected on its tangent plane.
// REQUIRES: a normal for each point
std::vector<double> delaunay_radii(const PointSet& points);

}  // namespace emap
