#include "libthin/estimation/variogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

// A field of many plane waves whose covariance is exp(-d²/2L²), with noise of variance `noise`.
ObservationSet gaussian_field(std::size_t count, double length_km, double noise, unsigned seed) {
  ObservationSet set = test::random_observations(count, 1, seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
  constexpr int waves = 400;
  std::vector<double> sum(count, 0.0);
  for (int i = 0; i < waves; ++i) {
    const double kx = normal(random) / length_km, ky = normal(random) / length_km, kz = normal(random) / length_km,
                 start = phase(random);
    for (std::size_t p = 0; p < count; ++p)
      sum[p] += std::cos(kx * set.position_km[p].x + ky * set.position_km[p].y + kz * set.position_km[p].z + start);
  }
  for (std::size_t p = 0; p < count; ++p)
    set.values[p] = sum[p] * std::sqrt(2.0 / waves) + std::sqrt(noise) * normal(random);
  return set;
}

TEST(Variogram, FindsLengthAndNoise) {
  for (const double length_km : {100.0, 200.0}) {
    const ObservationSet set = gaussian_field(3000, length_km, 0.25, 1);
    const auto variogram = fitted_variogram(places_of(set), set.values, 1);
    ASSERT_TRUE(variogram);
    EXPECT_NEAR(variogram->correlation_length_km, length_km, 0.2 * length_km);
    EXPECT_NEAR(variogram->nugget / (variogram->nugget + variogram->sill), 0.2, 0.05);
  }
}

TEST(Variogram, OfTooLittleIsNothing) {
  const ObservationSet few = test::random_observations(5, 1, 2);
  EXPECT_FALSE(fitted_variogram(places_of(few), few.values, 1));
  ObservationSet flat = test::random_observations(500, 1, 3);
  std::fill(flat.values.begin(), flat.values.end(), 3.0);
  EXPECT_FALSE(fitted_variogram(places_of(flat), flat.values, 1));
  EXPECT_FALSE(fitted_variogram(places_at({}), {}, 1));
}

}  // namespace
}  // namespace thin
