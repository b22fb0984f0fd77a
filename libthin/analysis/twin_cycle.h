#pragma once

// The twin experiment cycled: forecast, observe, thin, analyse, for weeks, once for every method, and forecasts of a
// week from the analyses (the stand-in for the thesis's figures 6.14 and 6.15).
//
// The truth is carried by the true wind, the forecasts by one with errors (analysis/transport_model.h). All methods see
// the same observations with the same errors, each with innovations of its own. The background error's standard
// deviation is taken from the variance of all innovations less that of the observation errors, its length from the
// options, the same for all methods.

#include <functional>
#include <string>
#include <vector>

#include "libthin/analysis/evaluation.h"
#include "libthin/analysis/twin_observations.h"

namespace thin {

struct TwinCycleOptions {
  int cycles = 0;  // 0: no cycling
  int hours = 6;
  int spin_up_cycles = 12;
  int count = 500;
  int observation_step = 3;
  double grid_deg = 2;
  double wind_error = 0.3;
  double assimilation_length_km = 400;
  double error_factor = 1;
  int forecast_days = 7;
  int forecast_every = 4;

  void declare(OptionTable& table);
};

struct CycledSet {
  std::string label;  // "none" (never analysed), "all", "farthest_point", "random", or the variant's
  std::optional<std::size_t> variant;
  // After the spin-up, a number for each cycle: root mean square over the Earth and the channels, K.
  std::vector<double> analysis_error_k, background_error_k;
  std::vector<double> retained;
  std::vector<double> length_km;  // by the variogram of all innovations, where it has one
  // Anomaly correlation with the truth, the anomaly from the truth's mean over all times; [day of lead][forecast].
  std::vector<std::vector<double>> northern, southern, global;
  bool failed = false;
};

struct TwinCycles {
  std::vector<CycledSet> sets;
  double truth_deviation_k = 0;  // of its anomaly
  std::vector<Evaluation::Failure> failures;
};

// [twin]'s observations, but for window and step. `seed` of everything.
// Errors: as twin_places(). A method's errors make a Failure.
Result<TwinCycles> twin_cycles(const std::vector<Variant>& variants, const TwinObservationOptions& observations,
                               const TwinCycleOptions& options, int seed,
                               const std::function<void(const std::string&)>& progress);

}  // namespace thin
