#pragma once

// Sampling of a partitioned surface on regular grids, one over each patch's base plane (thesis, 3.3.3).
//
// A sample belongs to a patch's map where the line through it along the plane's normal meets the patch; its elevation
// is where they meet (where they meet more than once, within the partition's fold tolerance: the highest). What lies at
// negative u or v of its plane's origin is not sampled: who quantises origins rounds them down.

#include <span>

#include "libemap/elevation/elevation_map.h"
#include "libemap/partition/partition.h"
#include "libemap/surface/mls_surface.h"
#include "libemap/surface/surface.h"

namespace emap {

// planes: one for each patch of the partition (base_planes(), or those after quantisation). A patch between whose
// samples everything falls comes back with columns = rows = 0. Deterministic for any number of threads.
// REQUIRES: spacing > 0, planes.size() == partition.patches.size(), partition.patch_of.size() == triangles
ElevationMaps resample_mesh(const Mesh& mesh, const Partition& partition, std::span<const BasePlane> planes,
                            double spacing);

// The same for points: samples lie where lines along the normal meet the MLS surface (Newton-like, figure 3.9), and
// belong to the patch of the input point nearest to where they do, as long as that is as near as the points are to each
// other. REQUIRES: a normal for each point
ElevationMaps resample_points(const PointSet& points, const MlsSurface& surface, const Partition& partition,
                              std::span<const BasePlane> planes, double spacing);
double spacing_for_resolution(const PointSet& points, const Partition& partition, std::span<const BasePlane> planes,
                              double mu);

// The spacing at which the maps hold about as many samples as the model has vertices, times mu.
double spacing_for_resolution(const Mesh& mesh, const Partition& partition, std::span<const BasePlane> planes,
                              double mu);

}  // namespace emap
