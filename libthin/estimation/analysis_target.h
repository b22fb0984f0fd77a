#pragma once

// What an analysis from fewer observations is held against, and the observations that are better not believed.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/estimation/gaussian_filter.h"
#include "libthin/estimation/places.h"

namespace thin {

// The observations at these indices as places of their own.
Places places_among(const Places& places, std::span<const std::uint32_t> chosen);

// Places no two of the same group of which are nearer than spacing_km, and every other is that near to one: each in
// turn unless one before it forbids. Ascending. 0: all. O(n + chosen log n + pairs).
std::vector<std::uint32_t> spread_places(const Places& places, double spacing_km);

// The filter's estimate from all observations at those of `points`; one row of channels for each.
// values: n x channels, none missing.
std::vector<double> filter_estimates(const Places& places, std::span<const double> values, std::size_t channels,
                                     std::span<const std::uint32_t> points, const GaussianFilter& filter);

// Flags the observations that the filter's estimate from the others misses, in any channel, by more than `limit` robust
// standard deviations (1.4826 times the median of the absolute misses); that is for one channel, and with several as
// much more as keeps false alarms at the number that one has by normal errors. Then all are tried once more against
// those left, so that none is blamed for its neighbour. Without neighbours nothing is flagged.
std::vector<std::uint8_t> gross_errors(const Places& places, std::span<const double> values, std::size_t channels,
                                       const GaussianFilter& filter, double limit);

// As many standard deviations for each of so many channels as give in all of them the false alarms that `limit` gives
// in one.
double limit_for_channels(double limit, std::size_t channels);

}  // namespace thin
