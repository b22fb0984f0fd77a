#pragma once

// The thesis's coder (4.2): shape-adaptive 9/7 wavelet, embedded bit planes by set splitting, and for each map the
// truncation that minimises squared error + lambda * bits (4.2.1, image-based distortion).

#include "libemap/coding/elevation_coder.h"

namespace emap {

ElevationCoder baseline_coder();

}  // namespace emap
