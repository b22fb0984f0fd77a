#pragma once

// Where one thinned set holds more than another (thesis figure 6.8): numbers retained per box of 100 km.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

struct BoxDifference {
  double latitude_deg, longitude_deg;  // of the centre; 0..360
  std::int32_t observations = 0;       // of the full set in the box
  std::int32_t retained = 0;
  std::int32_t reference = 0;  // retained by the other
};

// The boxes of nearly equal area that hold observations, from south to north, then eastwards. O(n).
std::vector<BoxDifference> density_difference(const ObservationSet& observations,
                                              std::span<const std::uint32_t> retained,
                                              std::span<const std::uint32_t> reference, double box_km = 100);

// Mean over the boxes of |retained - reference|.
double mean_absolute_difference(std::span<const BoxDifference> boxes);

}  // namespace thin
