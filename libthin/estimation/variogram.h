#pragma once

// How fast observations lose sight of each other: the variogram, and a nugget + Gaussian model of it,
//   gamma(d) = nugget + sill (1 - exp(-d² / 2 L²)),
// half the mean squared difference of two observations d apart. The nugget is their noise, L the correlation length of
// the signal (of a background covariance s² exp(-d²/2L²)).

#include <optional>
#include <span>

#include "libthin/estimation/places.h"

namespace thin {

struct Variogram {
  double nugget = 0;  // variance of the noise, in shares of the observations' variance
  double sill = 0;    // variance of the signal, likewise
  double correlation_length_km = 0;
};

// Fitted by least squares, weighted by numbers of pairs, over all channels in units of their variances, to the pairs
// among a sample of every stride-th place (1,500 at most) that are up to max_distance_km apart. Nothing where there are
// too few pairs, or no variance. values: n x channels.
std::optional<Variogram> fitted_variogram(const Places& places, std::span<const double> values, std::size_t channels,
                                          double max_distance_km = 2000);

}  // namespace thin
