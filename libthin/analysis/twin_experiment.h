#pragma once

// The analysis error of thinned sets where the truth is known (thesis 6.1, eq. 6.7), at one time.
//
// Innovations are observation error less background error, whatever the truth is: in a linear analysis it cancels, so
// that none is drawn. The background error is s(x) g(x), g of covariance exp(-d²/2L²) and s large in active regions,
// small in quiet ones (flow_dependence; 0: the same everywhere); half of its variance is common to all channels. The
// assimilation knows L, or what it takes for it, and the mean of s², as a centre's climatological covariance does.
// Every case has its own errors and its own part of the orbits.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libthin/analysis/evaluation.h"
#include "libthin/analysis/twin_observations.h"

namespace thin {

struct TwinOptions {
  TwinObservationOptions observations;
  std::vector<std::string> methods;
  std::vector<int> counts = {400, 1089};
  int cases = 8;
  int seed = 1;
  double background_error_k = 1;
  double background_length_km = 250;
  double flow_dependence = 0.8;
  std::optional<double> assimilation_length_km;
  std::vector<double> error_factors = {0.25, 0.35, 0.5, 0.7, 1, 1.4, 2, 2.8};

  void declare(OptionTable& table);
  double length_km() const { return assimilation_length_km.value_or(background_length_km); }
};

// One time: what is observed, and what the background's errors are at the places of judgement.
struct TwinCase {
  ObservationSet innovations;
  TwinErrors errors;                       // those in the innovations
  std::vector<double> fresh_k;             // innovations with other errors of the same kind, n x channels
  std::vector<Vector3> targets;            // GME level 6, within 100 km of an observation
  std::vector<double> background_error_k;  // background less truth, targets x channels
};
// Errors: as twin_places(); input, where nothing but land is seen
Result<TwinCase> twin_case(const TwinOptions& options, int number);

struct TwinScore {
  std::string label;  // "background", "all", "farthest_point", "random", or the variant's
  std::optional<std::size_t> variant;
  std::optional<std::int64_t> asked;
  // One number for each case, or for each factor and case: K², K, shares.
  std::vector<double> retained;                        // how many
  std::vector<std::vector<double>> mean_squared_k2;    // analysis less truth; [factor][case]
  std::vector<std::vector<double>> with_fresh_errors;  // the same places, observed with other errors
  std::vector<double> retained_error_k;                // root mean square of the observation errors retained
  std::vector<double> outlier_share;                   // of the retained
};

struct Twin {
  std::vector<TwinScore> scores;  // the background and all first
  std::vector<double> observations;
  std::vector<Evaluation::Failure> failures;
};

// Errors: as twin_case(). A method's errors make a Failure.
Result<Twin> twin_experiment(const std::vector<Variant>& variants, const TwinOptions& options,
                             const std::function<void(const std::string&)>& progress);

// Root mean squared error over that of the background, for each case, with R as it is (factor 1, or the nearest).
std::vector<double> nominal_errors(const TwinScore& score, const TwinScore& background, const TwinOptions& options);

// The same with R inflated by the factor that is best on the mean of the other cases.
std::vector<double> tuned_errors(const TwinScore& score, const TwinScore& background);
// That factor, by case.
std::vector<std::size_t> tuned_factors(const TwinScore& score);

}  // namespace thin
