#pragma once

// Coarser maps for views from afar (thesis, 7.2.1): every level halves the samples along both axes, so that the work
// for a picture follows its pixels and not the model's samples.

#include "libemap/elevation/elevation_map.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/rendering/camera.h"

namespace emap {

// The maps with every 2^level-th sample along both axes. Elevations are smoothed (1 2 1 along both axes, each level)
// where all neighbours are there. level 0: as they are.
ElevationMaps coarser_maps(const ElevationMaps& maps, int level);

// How gaps between the maps of a level are filled: farther on coarse ones, whose patches lost samples on both sides of
// a seam, and where a hole that closes by mistake is a few pixels wide.
GapFillingOptions filling_at_level(int level);

// The coarsest level whose samples, spacing_diagonals apart at level 0, are at most `pixels` apart where the model
// comes nearest to the eye; 0 where even the finest are farther.
int level_for_view(double spacing_diagonals, const Camera& camera, int picture_height, double pixels = 1);

}  // namespace emap
