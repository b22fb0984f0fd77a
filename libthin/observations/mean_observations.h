#pragma once

// Several observations as one: their mean, for methods that make observations instead of choosing some.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// Variable of the means: of how many each is.
inline const std::string kMeanOf = "mean_of";

// The mean of each group, in the order of the groups. Values and first guess: of the members that have them. Place: the
// mean position, brought onto the ellipsoid along the vertical; time: the mean, to the millisecond. Satellite,
// instrument and surface where all members share them, else unknown; no scan position. Of the variables there is
// kMeanOf alone: the mean of a flag means nothing. The source is the first member's.
// REQUIRES: no group is empty; members of a group have the channels of one instrument
ObservationSet mean_observations(const ObservationSet& observations,
                                 std::span<const std::vector<std::uint32_t>> groups);

}  // namespace thin
