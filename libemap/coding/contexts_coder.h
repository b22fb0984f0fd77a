#pragma once

// An interpolating 13/7 wavelet on the whole rectangle whose finest band is never coded, coefficients that the writer
// fits to the samples inside the mask, and context mixing.

#include "libemap/coding/elevation_coder.h"

namespace emap {

ElevationCoder contexts_coder();

}  // namespace emap
