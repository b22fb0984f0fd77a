#pragma once

// The estimation error of a thinned set for the report: on one common grid for whatever method, whole and per
// satellite.

#include <map>

#include "libthin/estimation/estimation_error.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

struct ThinnedError {
  double bandwidth_km;
  int level;  // of the GME grid that it was taken on
  EstimationError whole;
  std::map<std::int32_t, EstimationError> platforms;  // each on the grid points that its observations reach
};

// members: as Choice's.
Result<ThinnedError> thinned_error(const ObservationSet& observations, const Retained& retained,
                                   const std::vector<Retained>& members, double bandwidth_km);

}  // namespace thin
