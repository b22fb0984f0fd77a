#pragma once

// Methods x numbers to retain: every thinned set measured in the same ways, with what it cost.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libthin/analysis/common_error.h"
#include "libthin/analysis/density_difference.h"
#include "libthin/analysis/separation_statistics.h"
#include "libthin/analysis/variant.h"

namespace thin {

// [evaluate], but for its variants.
struct EvaluationOptions {
  std::vector<std::string> methods;
  std::vector<int> counts = {1000, 2000, 3000, 5000};
  double bandwidth_km = 100;
  int level = 8;
  int repetitions = 1;
  std::string reference = "stepwise";
  double box_km = 100;
  double noise_factor = 1.5;
  bool errors = true;
  bool list_boxes = false;
  bool list_retained = false;

  void declare(OptionTable& table);
};

// One thinned set. Everything in it depends on the observations and the options alone.
struct Evaluated {
  std::size_t variant = 0;             // place in the list of variants
  std::optional<std::int64_t> asked;   // to retain; nothing: the method stops by itself
  std::optional<double> fitted_value;  // of the variant's option `fit`
  Retained retained;
  std::vector<Retained> members;  // as Choice's
  std::vector<std::string> notes;
  SeparationStatistics separation;
  CommonError error;
  double signal_to_noise_observations_db = 0, signal_to_noise_grid_db = 0;
  double signal_free_share = 0;                  // of the retained
  std::optional<double> true_signal_free_share;  // where the observations carry the truth (kSignalFree)
  std::vector<BoxDifference> boxes;              // against the reference's set of the same number asked for; or empty
};

// What it took; differs from run to run and from machine to machine.
struct Cost {
  std::vector<double> seconds;                     // wall clock, one for each repetition
  std::vector<double> cpu_seconds;                 // of all threads
  std::optional<std::uint64_t> peak_memory_bytes;  // above what the process held before
};

struct Evaluation {
  std::vector<Evaluated> results;  // by variant, then by number asked for
  std::vector<Cost> costs;         // as results
  struct Failure {
    std::size_t variant;
    std::string reason;
  };
  std::vector<Failure> failures;  // variants that these observations are not fit for; they have no results

  double mean_absolute_value_k = 0;
  double signal_free_share = 0;  // of all observations
  std::optional<double> true_signal_free_share;
};

// Observations are in canonical order, prepared. `progress` gets a sentence before each piece of work.
// A method's errors make a Failure. Errors: configuration, where the evaluation itself would take too much memory.
Result<Evaluation> evaluate(const ObservationSet& observations, const std::vector<Variant>& variants,
                            const EvaluationOptions& options, const std::function<void(const std::string&)>& progress);

}  // namespace thin
