#pragma once

// The estimation error of thinned sets on common ground, so that methods can be compared: the same filter and the same
// evaluation points for all, whatever each of them was made with (thesis 6.5: the observations, and the grid G8).

#include <span>
#include <vector>

#include "libthin/estimation/estimation_error.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

struct CommonError {
  EstimationError at_observations;  // thesis eq. 6.11
  EstimationError on_grid;          // eq. 6.12, on the vertices of the GME grid that an observation reaches
};

struct CommonErrorOptions {
  double bandwidth_km = 100;
  int level = 8;
  std::size_t slice = std::size_t{1} << 17;  // evaluation points whose weights are in memory at one time
};

// One for each of the thinned sets. O((|Q| + entries) log n + sets x entries x channels), on all cores; the same bits
// for any number of them, but not for any slice.
// Errors: those of neighbourhood_table().
Result<std::vector<CommonError>> common_errors(const ObservationSet& observations,
                                               std::span<const Retained> thinned_sets,
                                               const CommonErrorOptions& options);

// The full set and the means that a method made of it (Choice::members) as one set.
struct FullAndMeans {
  ObservationSet observations;
  std::vector<std::uint8_t> is_full, is_mean;
};
FullAndMeans full_and_means(const ObservationSet& observations, std::span<const Retained> members);

// The same for one set of means.
Result<CommonError> common_error_of_means(const ObservationSet& observations, std::span<const Retained> members,
                                          const CommonErrorOptions& options);

// Mean over the observations of |f|, the length of the vector of their values; K.
double mean_absolute_value_k(const ObservationSet& observations);

// Signal-to-noise ratio in dB as in the thesis's figures 6.9 and 6.10, "the error relative to the mean absolute value
// of the signal": 20 log10(mean |f| / sqrt(E)). Infinite where E is 0.
double signal_to_noise_db(double mean_absolute_value_k, double mean_squared_error_k2);

}  // namespace thin
