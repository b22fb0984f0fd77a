#pragma once

// Helpers of the samplers: grids around what a patch spans.

#include <span>

#include "libemap/elevation/elevation_map.h"

namespace emap {

// A place over the plane: u and v in samples, the elevation in model units.
Eigen::Vector3d over_plane(const BasePlane& plane, double spacing, const Eigen::Vector3d& position);

// An empty patch with the samples from (0, 0) to (last_v, last_u); none where either is negative.
ElevationPatch empty_patch(const BasePlane& plane, double last_u, double last_v);

// Rows and columns at the far ends that hold no sample go.
void crop(ElevationPatch& patch);

// Just so many rows and columns without samples all around. The plane's origin stays, for the caller to move by as many
// samples as this returns.
struct ShiftedOrigin {
  std::int32_t columns, rows;
};
ShiftedOrigin set_margin(std::uint32_t margin, ElevationPatch& patch);

}  // namespace emap
