#pragma once

// A first guess out of other files: those of an assimilation's first pass, say, which hold model equivalents for the
// same fields of view.

#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct CompanionOptions {
  std::vector<std::string> files;  // paths, or patterns with * and ?
  double distance_km = 10;
  double minutes = 1;

  void declare(OptionTable& table);
};

// For every observation the first guess of the companion that is nearest in place, then in time, then first in
// canonical order, among those of the same satellite and instrument, with the same field of view where both know it,
// within the limits. Channels are matched by number. Replaces observations.first_guess_k; what has no companion is NaN
// there. O((n + m) log m).
void take_companions(ObservationSet& observations, const ObservationSet& companions, const CompanionOptions& options);

}  // namespace thin
