#pragma once

// Sets of made-up innovations on which methods are compared, ready to be thinned. Each is a function of its arguments
// alone; where there is no scan, every observation is a field of view of its own, so that none counts as a duplicate of
// another. In the variable kSignalFree every observation carries the truth: 1 where nothing but noise is to be seen, 0
// elsewhere.

#include <cstdint>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

inline constexpr const char* kSignalFree = "signal_free";

// AMSU-A channels 5 to 12 of NOAA-15 and NOAA-16 over sea, in the tracks of real orbits, from 2004-07-21T22:30Z on
// (thesis 6.5), cut off at `count` observations. Every second field of view, like the black ones of a chess board: so
// as many as the thesis had, 27,367, span its three hours.
ObservationSet orbit_innovations(std::size_t count, std::uint64_t seed = 1, bool noise = true);

// The same channels at the points of a Fibonacci spiral over the whole Earth, sea or land, all at one time: as many
// neighbours everywhere.
ObservationSet spiral_innovations(std::size_t count, std::uint64_t seed = 1, bool noise = true);

// Thesis 6.5, figure 6.16: `count` random points in a square of 1,000 km on the equator; one channel that rises from -1
// to 1 K within the 200 km in the middle. The thesis does not say how much it rises. `noise`: of 0.25 K.
ObservationSet gradient_innovations(std::size_t count, std::uint64_t seed = 1, bool noise = false);

// [synthetic]: one of the above, instead of files.
struct SyntheticOptions {
  enum class Source { none, orbits, spiral, gradient };
  Source source = Source::none;
  std::int64_t count = 27367;
  int seed = 1;
  bool noise = true;

  void declare(OptionTable& table);
  // REQUIRES: source is not none
  ObservationSet make() const;
};

}  // namespace thin
