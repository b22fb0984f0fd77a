#include "libthin/estimation/estimation_error.h"

#include <gtest/gtest.h>

#include "libthin/estimation/gme_grid.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(EstimationError, AgreesWithItsDefinition) {
  for (const std::size_t channels : {1U, 3U, 8U}) {
    const ObservationSet set = test::random_observations(120, channels, 4);
    const test::EstimationOracle oracle{set.position_km, set.position_km, set.values, channels, 150};
    const auto table = neighbourhood_table(places_of(set), places_of(set), {150});
    std::mt19937 random(9);
    for (const unsigned share : {0U, 5U, 50U, 100U}) {
      std::vector<std::uint8_t> retained(set.size());
      for (auto& flag : retained) flag = random() % 100 < share;
      const EstimationError error = estimation_error(*table, set.values, channels, retained);
      const double expected = oracle.error_sum({retained.begin(), retained.end()}) / 120;
      EXPECT_NEAR(error.mean_squared_k2, expected, 1e-12 * (1 + expected))
          << channels << " channels, " << share << " %";
      EXPECT_EQ(error.per_channel_k2.size(), channels);
      if (share == 0) {
        EXPECT_NEAR(error.mean_squared_k2, error.empty_mean_squared_k2, 1e-12);
      }
      if (share == 100) {
        EXPECT_EQ(error.mean_squared_k2, 0);
      }
    }
  }
}

TEST(EstimationError, CountsOnlyTheRowsAskedFor) {
  const ObservationSet set = test::random_observations(60, 2, 5);
  const std::vector<Vector3> half(set.position_km.begin(), set.position_km.begin() + 30);
  const auto all_rows = neighbourhood_table(places_of(set), places_of(set), {150});
  const auto half_rows = neighbourhood_table(places_at(half), places_of(set), {150});
  std::vector<std::uint8_t> retained(60, 0), counted(60, 0);
  for (std::size_t i = 0; i < 60; i += 4) retained[i] = 1;
  for (std::size_t i = 0; i < 30; ++i) counted[i] = 1;
  const EstimationError error = estimation_error(*all_rows, set.values, 2, retained, counted);
  EXPECT_EQ(error.evaluation_point_count, 30U);
  EXPECT_EQ(error.mean_squared_k2, estimation_error(*half_rows, set.values, 2, retained).mean_squared_k2);
}

TEST(EstimationError, OfNothingIsZero) {
  const auto table = neighbourhood_table(places_at(gme_grid(1)), places_at({}), {100});
  EXPECT_EQ(estimation_error(*table, {}, 2, {}).mean_squared_k2, 0);
}

}  // namespace
}  // namespace thin
