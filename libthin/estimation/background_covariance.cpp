#include "libthin/estimation/background_covariance.h"

#include <numbers>

namespace thin {
namespace {

constexpr double kLongScale = 4.0 / 3;  // the short one is half of it

}  // namespace

// exp(-d²/2L²) is exp(-d²/h²) with h = sqrt(2) L.
GaussianFilter BackgroundCovariance::filter() const {
  const double length_km = correlation_length_km * (two_scales ? kLongScale : 1);
  return {.bandwidth_km = std::numbers::sqrt2 * length_km,
          .reach_in_bandwidths = reach_in_lengths / std::numbers::sqrt2};
}

// Of the weights w with the long scale, w to the fourth power are those with half of it.
void BackgroundCovariance::from_weights(std::span<double> weights) const {
  if (!two_scales) return;
  for (double& weight : weights) weight = 0.5 * (weight + (weight * weight) * (weight * weight));
}

}  // namespace thin
