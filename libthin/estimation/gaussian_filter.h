#pragma once

// The linear filter that turns observations into a smooth estimate (thesis eq. 6.10):
//   est_P(x) = sum_p f(p) w(|x - p|) / sum_p w(|x - p|),   w(s) = exp(-s² / h²),   s <= 3h,   p in P.
// Where no observation of P is within 3h the estimate is 0: values are innovations, so the first guess stands.

#include <cmath>

namespace thin {

struct GaussianFilter {
  double bandwidth_km = 100;  // h

  double radius_km() const { return 3 * bandwidth_km; }
  double weight(double distance_squared_km2) const {
    return std::exp(-distance_squared_km2 / (bandwidth_km * bandwidth_km));
  }
};

}  // namespace thin
