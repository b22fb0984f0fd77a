#pragma once

// A mesh over a point set, through its points: what is cut into patches and sampled in the points' place.

#include "libemap/surface/surface.h"

namespace emap {

struct PointMeshOptions {
  double reach = 4;  // longest side of a triangle, in spacings of the points at its corners: wider gaps are holes
};

// All positions of the points, in their order, those that no triangle uses among them; triangles by an advancing front
// over the Delaunay triangulation (D. Cohen-Steiner, F. Da, 2004), turned so that most of each connected part agrees
// with the points' normals. No edge has more than two triangles. O(n log n), one thread.
// REQUIRES: a normal for each point
Mesh mesh_of_points(const PointSet& points, const PointMeshOptions& options = {});

}  // namespace emap
