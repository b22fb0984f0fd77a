#pragma once

// From temperatures to innovations. Thinning compares estimates with 0 where nothing is retained, which is right for
// innovations alone. Best are the model's equivalents out of the file itself or a companion; where the input has none,
// the simplest honest stand-in is the mean of the scan position.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

enum class FirstGuess {
  automatic,           // the file's where the file has one, else the mean of the scan position
  file,                // ObservationSet::first_guess_k, as the file has it
  companion,           // the same, out of another file (companion.h)
  scan_position_mean,  // mean of the window per satellite, instrument, channel and field of view: takes off the limb
                       // effect too
  none,                // values are thinned as they are
};

struct FirstGuessOptions {
  FirstGuess first_guess = FirstGuess::automatic;
  int minimum_lines = 10;  // a satellite with fewer takes its mean over all scan positions instead

  void declare(OptionTable& table);
};

// Where one observation has its first guess from.
enum class GuessSource : std::uint8_t {
  innovation,  // the values are innovations as they come
  given,       // first_guess_k
  scan_position_mean,
  none,
  missing,  // it should be in first_guess_k, and is not there for every channel that the observation measures
};

// With `automatic`, a file has a first guess for an instrument where it has one for any observation of it; then all
// others of that file and instrument should have one too.
std::vector<GuessSource> first_guess_sources(const ObservationSet& observations, FirstGuess first_guess);

struct FirstGuessCounts {
  std::size_t innovations = 0, given = 0, scan_position_mean = 0, none = 0;
};

// Subtracts the first guess from the values in place, drops first_guess_k and sets value_kind. Then takes off the mean
// of every channel whose mean is more than half its standard deviation: a bias would make the zero wrong. What was done
// that a user should know is appended to `notes`, a sentence each. The sums run in the order of the observations: bring
// them into canonical order first. sources: as first_guess_sources gives them. REQUIRES: no missing values in channels
// that an observation measures, no source `missing`
FirstGuessCounts subtract_first_guess(ObservationSet& observations, const std::vector<GuessSource>& sources,
                                      const FirstGuessOptions& options, std::vector<std::string>& notes);

}  // namespace thin
