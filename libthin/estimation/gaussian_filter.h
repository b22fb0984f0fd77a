#pragma once

// The linear filter that turns observations into a smooth estimate (thesis eq. 6.10):
//   est_P(x) = sum_p f(p) w(|x - p|) / sum_p w(|x - p|),   w(s) = exp(-s² / h²),   s <= 3h,   p in P.
// Where no observation of P is within 3h the estimate is 0: values are innovations, so the first guess stands.

#include <span>

namespace thin {

struct GaussianFilter {
  double bandwidth_km = 100;       // h
  double reach_in_bandwidths = 3;  // where it is cut off

  double radius_km() const { return reach_in_bandwidths * bandwidth_km; }

  // w of each squared distance, km², to within 2 units in the last place. The exponential is our own, of nothing but
  // additions and multiplications, so that its bits are the same on every processor. REQUIRES: 0 <= each <= (26 h)²
  void weigh(std::span<const double> distances_squared_km2, double* weights) const;
  double weight(double distance_squared_km2) const;
};

}  // namespace thin
