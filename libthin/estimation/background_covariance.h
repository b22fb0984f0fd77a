#pragma once

// How the error of a background is taken to be correlated in space: B(p, q) = s² exp(-|p - q|² / 2L²), or where L is a
// guess the mean of two such with 2/3 L and 4/3 L, which is wrong by less for any L near it. In shares of s²: B(p, p)
// = 1. Cut off at 3L (two scales: 4L), which is no true covariance any more: where more than 3 observations are
// retained in an area of L², one scale must reach to 3.25L, with more than 6.5 to 3.5L, or analysis variances may fall
// below 0 and the analysis with them.

#include <span>

#include "libthin/estimation/gaussian_filter.h"

namespace thin {

struct BackgroundCovariance {
  double correlation_length_km = 250;  // L
  bool two_scales = false;
  double reach_in_lengths = 3;  // of the longer scale

  double radius_km() const { return filter().radius_km(); }

  // The filter whose neighbourhoods are those of the covariance; from_weights() makes its weights the covariances.
  GaussianFilter filter() const;
  void from_weights(std::span<double> weights) const;
};

}  // namespace thin
