#pragma once

// The choice of h, the bandwidth of the Gaussian filter: given, or from the observations themselves.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libthin/estimation/places.h"
#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"

namespace thin {

// Mean over a sample of p (every stride-th, kBandwidthSample of them at most), per channel, of |est(p) - f(p)| with all
// observations (leave_one_out false) or of (est(p) - f(p))² with all but p (true); 0 is the estimate where there are no
// others. values: n x channels, K. O(sample log n + pairs).
std::vector<double> filter_misfit(const Places& places, std::span<const double> values, std::size_t channels,
                                  double bandwidth_km, bool leave_one_out);

constexpr std::size_t kBandwidthSample = 4000;

// The h that predicts an observation from its neighbours best: the least sum over channels of the squared misfit of
// leave-one-out, each in units of its channel's variance. To within 2 per cent. No observations: nothing.
std::optional<double> cross_validated_bandwidth_km(const Places& places, std::span<const double> values,
                                                   std::size_t channels);

// Thesis 6.4.2: the largest h for which the mean of |est_P0(p) - f(p)| is at most 0.05 E_max in every channel, E_max
// being the bound on the measurement error, K. With noisy observations that is about their spacing: the filter must not
// smooth the noise away. To within 2 per cent. Nothing, where even the least h misses by more.
std::optional<double> error_bound_bandwidth_km(const Places& places, std::span<const double> values,
                                               std::size_t channels, std::span<const double> error_bounds_k);

struct BandwidthOptions {
  enum class Rule { fixed, cross_validation, error_bound };
  Rule rule = Rule::fixed;
  std::optional<double> bandwidth_km;  // kDefaultBandwidthKm where fixed and unset
  std::vector<double> error_bounds_k;

  void declare(OptionTable& table);
  struct Conflict {
    std::string key, problem;
  };
  std::optional<Conflict> conflict() const;

  // values: K, of the channels in use.
  // Errors: configuration, where error_bounds has another number of channels, or no h meets it.
  Result<double> choose(const Places& places, std::span<const double> values, std::size_t channels) const;
};

constexpr double kDefaultBandwidthKm = 100;

}  // namespace thin
