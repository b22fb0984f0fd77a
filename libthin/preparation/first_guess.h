#pragma once

// From temperatures to innovations. Thinning compares estimates with 0 where nothing is retained, which is right for
// innovations alone; where the input has none, the simplest honest stand-in is the mean of the scan position.

#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

enum class FirstGuess {
  scan_position_mean,  // mean of the window per satellite, channel and field of view: takes off the limb effect too
  none,                // values are thinned as they are
};

struct FirstGuessOptions {
  FirstGuess first_guess = FirstGuess::scan_position_mean;
  int minimum_lines = 10;  // a satellite with fewer takes its mean over all scan positions instead

  void declare(OptionTable& table);
};

// Subtracts the first guess from the values in place; sets value_kind. Input that is innovations already stays as it
// is. Then takes off the mean of every channel whose mean is more than half its standard deviation: a bias would make
// the zero wrong. What was done that a user should know is appended to `notes`, a sentence each. The sums run in the
// order of the observations: bring them into canonical order first. REQUIRES: no missing values
void subtract_first_guess(ObservationSet& observations, const FirstGuessOptions& options,
                          std::vector<std::string>& notes);

}  // namespace thin
