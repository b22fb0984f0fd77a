#pragma once

// Where a twin experiment is observed, and with what errors.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct TwinObservationOptions {
  std::vector<std::string> satellites = {"NOAA-15", "NOAA-16"};
  std::string begin = "2004-07-21T22:30:00Z";
  int window_minutes = 30;
  int step = 1;
  int channels = 1;
  double observation_error_k = 0.4;
  double correlated_error_k = 0;
  double correlated_length_km = 140;
  double outlier_share = 0;
  double outlier_size_k = 3;
  double bias_k = 0;

  void declare(OptionTable& table);
  // Of the errors that belong to the observations, white and correlated together, K; outliers and bias apart.
  double total_error_k() const;
};

// The fields of view of AMSU-A over sea that the satellites see from begin_ms for the window: every step-th of every
// step-th line. `channels` columns, all 0; canonical order.
// Error: configuration, where a satellite is unknown.
Result<ObservationSet> twin_places(const TwinObservationOptions& options, std::int64_t begin_ms);

// Errors of the observations, n x channels: white, plus correlated ones, plus for a share of the observations an
// outlier of `outlier_size_k` with either sign, the same in all channels.
struct TwinErrors {
  std::vector<double> errors_k;
  std::vector<std::uint8_t> is_outlier;  // n
};
TwinErrors twin_errors(const ObservationSet& places, const TwinObservationOptions& options, std::uint64_t seed);

}  // namespace thin
