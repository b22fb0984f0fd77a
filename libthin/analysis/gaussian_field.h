#pragma once

// Random smooth fields on the sphere whose statistics are known exactly: sums of waves in space.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// Mean 0, variance 1, covariance exp(-d²/2L²) over the ensemble of seeds, d the chord: sqrt(2/W) sum of cos(k x +
// phase) with wave vectors k normal of deviation 1/L (random Fourier features, Rahimi and Recht 2007). With W waves a
// single field is normal to about 1/W. The same numbers with any standard library.
class GaussianField {
 public:
  // REQUIRES: length_km > 0
  GaussianField(std::uint64_t seed, double length_km, int waves = 256);

  double at(const Vector3& position_km) const;
  std::vector<double> at(std::span<const Vector3> positions_km) const;  // on all cores

 private:
  struct Wave {
    Vector3 vector_per_km;
    double phase_rad;
  };
  std::vector<Wave> waves_;
};

// Independent normal numbers of variance 1, the same with any standard library.
std::vector<double> normal_numbers(std::size_t count, std::uint64_t seed);

}  // namespace thin
