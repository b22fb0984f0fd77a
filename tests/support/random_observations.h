#pragma once

// Observations for tests of the methods: random places, a smooth signal with noise.

#include <cmath>
#include <numbers>
#include <random>

#include "libthin/observations/observation_set.h"

namespace thin::test {

struct Region {
  double south_deg = -10, north_deg = 10, west_deg = 170, east_deg = 190;
};

inline ObservationSet random_observations(std::size_t count, std::size_t channels, unsigned seed, Region region = {}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> noise(0, 0.2);
  ObservationSet set;
  set.value_kind = ValueKind::innovation;
  for (std::size_t c = 0; c < channels; ++c) set.channels.push_back(static_cast<int>(c) + 1);
  std::vector<double> values(channels);
  for (std::size_t i = 0; i < count; ++i) {
    ObservationSet::Entry entry;
    entry.latitude_deg = region.south_deg + (region.north_deg - region.south_deg) * unit(random);
    entry.longitude_deg = region.west_deg + (region.east_deg - region.west_deg) * unit(random);
    entry.time_ms = static_cast<std::int64_t>(i) * 200;
    entry.platform = 206 + static_cast<int>(i % 2);
    entry.scan_line = static_cast<int>(i / 30);
    entry.field_of_view = static_cast<int>(i % 30) + 1;
    entry.source = {0, static_cast<std::uint32_t>(i / 100), static_cast<std::uint32_t>(i % 100)};
    for (std::size_t c = 0; c < channels; ++c)
      values[c] = std::sin(entry.latitude_deg * 0.6 + static_cast<double>(c)) * std::cos(entry.longitude_deg * 0.4) +
                  noise(random);
    set.push_back(entry, values);
  }
  return set;
}

// The whole globe, evenly: n points on a Fibonacci spiral, so that the number of neighbours is the same everywhere.
inline ObservationSet spiral_observations(std::size_t count, std::size_t channels, unsigned seed) {
  ObservationSet set = random_observations(0, channels, seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<double> values(channels);
  for (std::size_t i = 0; i < count; ++i) {
    ObservationSet::Entry entry;
    const double height = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    entry.latitude_deg = std::asin(height) * 180 / std::numbers::pi;
    entry.longitude_deg = std::fmod(static_cast<double>(i) * 137.50776405003785, 360.0);
    entry.time_ms = static_cast<std::int64_t>(i);
    for (std::size_t c = 0; c < channels; ++c)
      values[c] = std::sin(entry.latitude_deg * 0.2 + static_cast<double>(c)) * std::cos(entry.longitude_deg * 0.15) +
                  noise(random);
    set.push_back(entry, values);
  }
  return set;
}

}  // namespace thin::test
