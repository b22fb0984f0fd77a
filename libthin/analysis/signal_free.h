#pragma once

// Where a set of observations has nothing to say but noise. Noise attracts points there: a method that retains many of
// them has taken it for signal (Lazarus et al. 2010).

#include <cstdint>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct SignalFreeOptions {
  double bandwidth_km = 100;  // h of the estimate; what is near is within 3h
  double noise_factor = 1.5;  // how many times what noise alone makes of it the estimate may vary
};

// For each observation whether it lies in a signal-free area: where est_P0, the full set's estimate, varies no more
// over the observations near it than noise_factor times what noise alone would make of it.
// - Varies: the variance of est_P0, the mean of the channels, each in units of its variance over all observations.
//   Channels whose estimate is the same everywhere do not count.
// - Noise alone: in each channel its variance sigma² times sum w² / (sum w)² at the observation, in the same units.
// - sigma²: the median over all observations of (f - est_P0)² / (1 - 2 / sum w + sum w² / (sum w)²), which has the mean
//   sigma² where f is noise, divided by the median of the chi-squared distribution of one degree of freedom. Signals
//   disturb it little as long as they fill less than half of the set.
// O(pairs within 3h x channels). Errors: those of neighbourhood_table().
Result<std::vector<std::uint8_t>> signal_free(const ObservationSet& observations, const SignalFreeOptions& options);

// Share of these observations for which `flags` is not 0; 0 where there are none.
double share_of(const std::vector<std::uint8_t>& flags, const std::vector<std::uint32_t>& observations);

}  // namespace thin
