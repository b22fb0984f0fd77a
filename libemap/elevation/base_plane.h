#pragma once

// Base planes of the patches of a partition: where each patch's elevation map lies in space (thesis, 3.3.1).

#include <span>

#include "libemap/elevation/elevation_map.h"
#include "libemap/partition/partition.h"
#include "libemap/surface/surface.h"

namespace emap {

// Right-handed frame around a unit normal, the same for the same normal: for who codes the normal alone.
BasePlane plane_with_normal(const Eigen::Vector3d& normal);

// One plane for each patch. The normal is the patch's; axis_u and axis_v are turned so that the patch's bounding
// rectangle is as small as it gets within the plane; the origin is the corner at which u, v and the elevation are
// least.
std::vector<BasePlane> base_planes(const Mesh& mesh, const Partition& partition);
std::vector<BasePlane> base_planes(const PointSet& points, const Partition& partition);

}  // namespace emap
