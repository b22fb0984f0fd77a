#pragma once

// Where things are, in the metric that the filter and the clustering measure distances in: km in space, and where time
// counts (thesis 7.2.2, for 4D assimilation) km that stand for the hours passed, as a fourth coordinate.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

struct Places {
  int dimension = 3;                // 3, or 4 with time
  std::vector<double> coordinates;  // size() x dimension, km
  // Of each, or empty for all alike: only places of the same group see each other. Groups are the instruments of a
  // window that is thinned jointly, since what one measures says nothing about the channels of another.
  std::vector<std::uint8_t> group;

  std::size_t size() const { return coordinates.size() / static_cast<std::size_t>(dimension); }
  std::span<const double> of(std::size_t i) const {
    return std::span(coordinates).subspan(i * static_cast<std::size_t>(dimension), static_cast<std::size_t>(dimension));
  }
  std::uint8_t group_of(std::size_t i) const { return group.empty() ? std::uint8_t{0} : group[i]; }
};

// In space alone.
Places places_at(std::span<const Vector3> positions_km);

// Of observations: with time_scale_km_per_hour > 0 an hour counts as so many km; the groups are the instruments where
// the set has channels of several.
Places places_of(const ObservationSet& observations, double time_scale_km_per_hour = 0);

// Evaluation points for these observations: each position for each group, and where time counts for each of a series of
// times, `time_step_km` apart at most, that begins and ends with the observations'.
Places evaluation_places(std::span<const Vector3> positions_km, const Places& observations, double time_step_km);

}  // namespace thin
