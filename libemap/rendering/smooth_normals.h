#pragma once

// Normals that shading interpolates: at a vertex the mean of its triangles' normals with the weights of N. Max (Weights
// for computing vertex normals from facet normals, 1999), which give a sphere's own normals however its triangles lie.
// Area-weighted means (surface/mesh_normals.h) lean where triangles are uneven: along the seams of the patches.

#include "libemap/surface/surface.h"

namespace emap {

// Of unit length; zero where a vertex has no triangle with an area around it.
std::vector<Eigen::Vector3d> smooth_normals(const Mesh& mesh);

}  // namespace emap
