#include "libthin/analysis/confidence.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace thin {

double student_t_975(std::size_t degrees_of_freedom) {
  assert(degrees_of_freedom >= 1);
  constexpr std::array few = {12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462, 2.30600, 2.26216, 2.22814};
  if (degrees_of_freedom <= few.size()) return few[degrees_of_freedom - 1];
  // Cornish-Fisher (Abramowitz and Stegun 26.7.5): good to 1e-4 from 11 on.
  constexpr double z = 1.959963984540054, z2 = z * z;
  const auto v = static_cast<double>(degrees_of_freedom);
  return z + z * (z2 + 1) / (4 * v) + z * ((5 * z2 + 16) * z2 + 3) / (96 * v * v) +
         z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * v * v * v);
}

MeanWithInterval mean_with_interval(std::span<const double> measurements) {
  assert(!measurements.empty());
  const auto n = static_cast<double>(measurements.size());
  double sum = 0, squares = 0;
  for (const double each : measurements) sum += each;
  const double mean = sum / n;
  for (const double each : measurements) squares += (each - mean) * (each - mean);
  if (measurements.size() < 2) return {mean, 0};
  return {mean, student_t_975(measurements.size() - 1) * std::sqrt(squares / (n - 1) / n)};
}

}  // namespace thin
