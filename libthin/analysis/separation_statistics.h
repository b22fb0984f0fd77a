#pragma once

// How far retained observations stand from each other: observation errors are correlated over short distances, which
// thinning is there to avoid.

#include <cstdint>
#include <span>

#include "libthin/observations/observation_set.h"

namespace thin {

// Of the chord from each retained observation to the nearest other one, km. All 0 where fewer than two are retained.
// Percentiles are the order statistic at the rounded-up share (nearest rank): half are at most median_km.
struct SeparationStatistics {
  double minimum_km = 0;
  double mean_km = 0;
  double percentile_5_km = 0;
  double percentile_25_km = 0;
  double median_km = 0;
  double percentile_75_km = 0;
  double percentile_95_km = 0;
};

// O(n log n).
SeparationStatistics separation_statistics(const ObservationSet& observations, std::span<const std::uint32_t> retained);

}  // namespace thin
