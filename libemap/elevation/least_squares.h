#pragma once

// Elevations that make the canonical triangles, not only their corners, lie on the surface (thesis, 3.3.5).

#include "libemap/elevation/elevation_map.h"

namespace emap {

// The spacing of maps with `samples_per_unknown` times as many samples: the thesis asks for 5.
double fitting_spacing(double spacing, double samples_per_unknown = 5);

struct FittingOptions {
  int iterations = 60;      // of conjugate gradients, at most
  double tolerance = 1e-6;  // of the residual, relative to where it began
};

// Moves the elevations of `maps` so that the squared differences between their canonical triangles and the samples of
// `fine` are least: conjugate gradients on the normal equations, from the elevations as they are, patch by patch. fine:
// the same surface over the same planes, sampled at fitting_spacing(). Samples under no triangle do not count, and
// elevations that no sample depends on stay. Deterministic for any number of threads.
// REQUIRES: the same number of patches, with the same planes
void fit_elevations(const ElevationMaps& fine, ElevationMaps& maps, const FittingOptions& options = {});

}  // namespace emap
