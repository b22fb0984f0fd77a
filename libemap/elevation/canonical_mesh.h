#pragma once

// Elevation maps as a mesh or as points (thesis, 3.3.4). Samples come patch by patch, row by row, so that vertex i of
// the mesh is point i of the point set.

#include "libemap/elevation/elevation_map.h"
#include "libemap/surface/surface.h"

namespace emap {

struct CanonicalOptions {
  // Triangles whose angle to their base plane is wider are left out: where the surface turns away from the plane and
  // another part of the patch lies beside it in the map, they would be walls that the surface does not have.
  double steepest_degrees = 85;
};

// Every square of four supported samples becomes two triangles along its shorter diagonal, every three supported
// samples of a square one triangle. Patches are not connected.
Mesh canonical_mesh(const ElevationMaps& maps, const CanonicalOptions& options = {});

// The patch of each vertex of the mesh, and of each point.
std::vector<std::uint32_t> patches_of_samples(const ElevationMaps& maps);

// All samples with normals from the elevations' differences.
PointSet sample_points(const ElevationMaps& maps);

}  // namespace emap
