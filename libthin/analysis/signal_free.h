#pragma once

// Where a set of observations has nothing to say. Noise attracts points there: a method that retains many of them has
// taken noise for signal (Lazarus et al. 2010).

#include <cstdint>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct SignalFreeOptions {
  double bandwidth_km = 100;      // h of the estimate; variances are taken over what is within 3h
  double largest_variance = 0.2;  // an observation is in a signal-free area where less than this varies
};

// For each observation whether it lies in a signal-free area: where the variance of est_P0, the full set's estimate,
// over the observations within 3h of it is less than largest_variance of that over all observations; each channel in
// units of its variance over all, then the mean of the channels. Channels whose estimate is the same everywhere don't
// count. O(pairs within 3h x channels).
// Errors: those of neighbourhood_table().
Result<std::vector<std::uint8_t>> signal_free(const ObservationSet& observations, const SignalFreeOptions& options);

// Share of these observations for which `flags` is not 0; 0 where there are none.
double share_of(const std::vector<std::uint8_t>& flags, const std::vector<std::uint32_t>& observations);

}  // namespace thin
