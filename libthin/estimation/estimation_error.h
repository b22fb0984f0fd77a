#pragma once

// How well a thinned set stands for the full one (thesis eq. 6.11, 6.12):
//   E(P) = 1/|Q| sum over q in Q of |est_P0(q) - est_P(q)|²

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/estimation/neighbourhood_table.h"

namespace thin {

struct EstimationError {
  double mean_squared_k2 = 0;              // E, summed over channels
  std::vector<double> per_channel_k2;      // its part of each channel
  double empty_mean_squared_k2 = 0;        // E of retaining nothing: mean |est_P0|², the scale to see E on
  std::size_t evaluation_point_count = 0;  // |Q|
};

// values: n x channels, K, none missing. retained: n, not 0 for the observations in P. Q are the rows of `table`, or
// those of them for which `counted` (as many as rows) is not 0.
// `full`: likewise, of the observations in P0, for a P that is not a subset of it: then the observations are those of
// both. Empty: all.
// Straight from the definition; O(entries x channels), on all cores, the same bits for any number of them.
EstimationError estimation_error(const NeighbourhoodTable& table, std::span<const double> values, std::size_t channels,
                                 std::span<const std::uint8_t> retained, std::span<const std::uint8_t> counted = {},
                                 std::span<const std::uint8_t> full = {});

}  // namespace thin
