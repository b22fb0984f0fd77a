#pragma once

// What an error in elevation means for the surface: on a slope the distance to the surface is smaller than the
// difference in elevation by the cosine of the angle, and the area that it stands for is larger by as much. The
// integral of squared distances over the surface therefore weighs a sample by that cosine.

#include "libemap/elevation/elevation_map.h"

namespace emap {

// Mean of these cosines over a map's samples; 1 for a map without samples.
double mean_surface_weight(const ElevationPatch& patch, double spacing);

// Area of the surface over the map: the sum of spacing² / cosine.
double surface_area(const ElevationPatch& patch, double spacing);

}  // namespace emap
