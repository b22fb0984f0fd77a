#pragma once

// What libthin/analysis measures, each from its definition with all pairs of observations.

#include <algorithm>
#include <cmath>
#include <vector>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/observation_set.h"

namespace thin::test {

// Of each of these to the nearest other, km; ascending.
inline std::vector<double> nearest_distances_km(const ObservationSet& set, const std::vector<std::uint32_t>& retained) {
  std::vector<double> distances_km;
  for (const std::uint32_t a : retained) {
    double nearest = 1e9;
    for (const std::uint32_t b : retained)
      if (a != b) nearest = std::min(nearest, chord_km(set.position_km[a], set.position_km[b]));
    distances_km.push_back(nearest);
  }
  std::sort(distances_km.begin(), distances_km.end());
  return distances_km;
}

inline double mean(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum / static_cast<double>(numbers.size());
}

inline double variance(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += (number - mean(numbers)) * (number - mean(numbers));
  return sum / static_cast<double>(numbers.size());
}

// As libthin/analysis/signal_free.h defines it. How far each observation is from the limit: below 0, it is in a
// signal-free area.
inline std::vector<double> beyond_noise(const ObservationSet& set, double bandwidth_km, double noise_factor) {
  const std::size_t n = set.size(), channels = set.channel_count();
  const auto weight = [&](std::size_t a, std::size_t b) {
    const double s = chord_km(set.position_km[a], set.position_km[b]);
    return s <= 3 * bandwidth_km ? std::exp(-s * s / (bandwidth_km * bandwidth_km)) : 0.0;
  };
  std::vector<double> weight_sum(n, 0), remaining(n, 0), beyond(n, 0);
  std::vector<std::vector<double>> estimate(channels, std::vector<double>(n, 0));
  for (std::size_t q = 0; q < n; ++q) {
    for (std::size_t p = 0; p < n; ++p) {
      weight_sum[q] += weight(q, p);
      remaining[q] += weight(q, p) * weight(q, p);
      for (std::size_t c = 0; c < channels; ++c) estimate[c][q] += weight(q, p) * set.values_of(p)[c];
    }
    remaining[q] /= weight_sum[q] * weight_sum[q];
    for (std::size_t c = 0; c < channels; ++c) estimate[c][q] /= weight_sum[q];
  }
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<double> squares;
    for (std::size_t q = 0; q < n; ++q)
      squares.push_back(std::pow(set.values_of(q)[c] - estimate[c][q], 2) / (1 - 2 / weight_sum[q] + remaining[q]));
    std::sort(squares.begin(), squares.end());
    const double noise = squares[n / 2] / 0.45493642311957283;
    const double whole = variance(estimate[c]);
    for (std::size_t q = 0; q < n; ++q) {
      std::vector<double> near;
      for (std::size_t p = 0; p < n; ++p)
        if (weight(q, p) > 0) near.push_back(estimate[c][p]);
      beyond[q] += (variance(near) - noise_factor * noise * remaining[q]) / whole;
    }
  }
  return beyond;
}

}  // namespace thin::test
