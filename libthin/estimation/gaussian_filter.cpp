#include "libthin/estimation/gaussian_filter.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "libthin/estimation/lanes.h"

namespace thin {
namespace {

using IntegerLanes = std::int64_t __attribute__((vector_size(sizeof(Lanes))));

constexpr double kLog2E = 1.4426950408889634;
// ln 2 in two parts, of which the first has so few digits that its product with a small whole number is exact.
constexpr double kLn2High = 6.93147180369123816490e-01;
constexpr double kLn2Low = 1.90821492927058770002e-10;
// Added and taken off again, it leaves a number rounded to the nearest whole one, which then stands in the last bits.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52
constexpr int kFractionBits = 52;

// Of the Taylor series of exp, from the highest: |x| <= ln 2 / 2 leaves less than 1e-17.
constexpr double kCoefficients[] = {
    1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
    1.0 / 720,        1.0 / 120,       1.0 / 24,       1.0 / 6,       0.5,          1.0,         1.0};

inline __attribute__((always_inline)) Lanes exponential(const Lanes& x) {
  const Lanes rounded = x * kLog2E + kRounder;
  const Lanes whole = rounded - kRounder;
  const Lanes rest = (x - whole * kLn2High) - whole * kLn2Low;
  Lanes sum = Lanes{} + kCoefficients[0];
  for (std::size_t i = 1; i < std::size(kCoefficients); ++i) sum = sum * rest + kCoefficients[i];
  // Times 2 to the power `whole`: added to the exponent.
  return reinterpret_cast<Lanes>(reinterpret_cast<IntegerLanes>(sum) +
                                 (reinterpret_cast<IntegerLanes>(rounded) << kFractionBits));
}

THIN_VECTOR_CLONES void weigh_all(const double* distances_squared, std::size_t count, double scale, double* weights) {
  std::size_t i = 0;
  for (; i + kLaneCount <= count; i += kLaneCount) store(exponential(load(distances_squared + i) * scale), weights + i);
  if (i == count) return;
  double rest[kLaneCount] = {};
  std::copy(distances_squared + i, distances_squared + count, rest);
  store(exponential(load(rest) * scale), rest);
  std::copy(rest, rest + (count - i), weights + i);
}

}  // namespace

void GaussianFilter::weigh(std::span<const double> distances_squared_km2, double* weights) const {
  weigh_all(distances_squared_km2.data(), distances_squared_km2.size(), -1 / (bandwidth_km * bandwidth_km), weights);
}

double GaussianFilter::weight(double distance_squared_km2) const {
  double weight = 0;
  weigh({&distance_squared_km2, 1}, &weight);
  return weight;
}

}  // namespace thin
