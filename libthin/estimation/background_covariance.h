#pragma once

// How the error of a background is taken to be correlated in space: B(p, q) = s² exp(-|p - q|² / 2L²), or where L is a
// guess the mean of two such with 2/3 L and 4/3 L, which is wrong by less for any L near it. Cut off at 3L (two scales:
// 4L), in shares of s²: B(p, p) = 1.

#include <span>

#include "libthin/estimation/gaussian_filter.h"

namespace thin {

struct BackgroundCovariance {
  double correlation_length_km = 250;  // L
  bool two_scales = false;

  double radius_km() const { return filter().radius_km(); }

  // The filter whose neighbourhoods are those of the covariance; from_weights() makes its weights the covariances.
  GaussianFilter filter() const;
  void from_weights(std::span<double> weights) const;
};

}  // namespace thin
