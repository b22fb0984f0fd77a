#include "libthin/thinning/greedy_removal.h"

#include <gtest/gtest.h>

#include "libthin/estimation/estimation_error.h"
#include "libthin/estimation/gme_grid.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

std::vector<std::uint32_t> removal_order(const ObservationSet& set, const std::vector<Vector3>& points,
                                         double bandwidth_km, Update update) {
  auto table = neighbourhood_table(points, set.position_km, {bandwidth_km});
  RemovalSums sums(std::move(*table), set.values, set.channel_count());
  std::vector<std::uint32_t> removed;
  EXPECT_TRUE(remove_greedily(sums, 0, update, &removed).empty());
  return removed;
}

// Each step of full updating takes the true minimum: every increment recomputed from the definition.
void expect_every_step_is_the_minimum(const ObservationSet& set, const std::vector<Vector3>& points,
                                      double bandwidth_km) {
  const test::EstimationOracle oracle{points, set.position_km, set.values, set.channel_count(), bandwidth_km};
  std::vector<bool> retained(set.size(), true);
  for (const std::uint32_t chosen : removal_order(set, points, bandwidth_km, Update::full)) {
    const std::vector<double> increments = oracle.increments(retained);
    ASSERT_TRUE(retained[chosen]);
    const double tolerance = 1e-10 * (1 + oracle.error_sum(retained));
    for (std::size_t p = 0; p < set.size(); ++p) {
      if (!retained[p]) continue;
      ASSERT_LE(increments[chosen], increments[p] + tolerance) << chosen << " was taken before " << p;
    }
    retained[chosen] = false;
  }
  EXPECT_EQ(std::count(retained.begin(), retained.end(), true), 0);
}

TEST(GreedyRemoval, TakesTheTrueMinimumOnTheGrid) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    expect_every_step_is_the_minimum(test::random_observations(60, 1 + seed, seed), gme_grid(4), 250);
  }
}

TEST(GreedyRemoval, TakesTheTrueMinimumAtTheObservations) {
  const ObservationSet set = test::random_observations(50, 2, 5);
  expect_every_step_is_the_minimum(set, set.position_km, 150);
}

TEST(GreedyRemoval, TakesTheTrueMinimumAroundThePole) {
  const ObservationSet set = test::random_observations(60, 2, 6, {85, 90, 0, 360});
  expect_every_step_is_the_minimum(set, gme_grid(5), 150);
}

TEST(GreedyRemoval, TakesEqualOnesByIndex) {
  ObservationSet set = test::random_observations(20, 1, 7);
  std::fill(set.values.begin(), set.values.end(), 0.0);
  std::vector<std::uint32_t> expected(20);
  for (std::uint32_t p = 0; p < 20; ++p) expected[p] = p;
  EXPECT_EQ(removal_order(set, set.position_km, 100, Update::full), expected);
}

TEST(GreedyRemoval, LazyRemovesEachOnceAndComesClose) {
  const ObservationSet set = test::random_observations(800, 3, 8);
  const std::vector<Vector3> grid = gme_grid(6);
  std::vector<std::uint32_t> order = removal_order(set, grid, 150, Update::lazy);
  const auto error_at_80 = [&](Update update) {
    auto table = neighbourhood_table(grid, set.position_km, {150});
    RemovalSums sums(std::move(*table), set.values, 3);
    EXPECT_EQ(remove_greedily(sums, 80, update).size(), 80U);
    return sums.error_sum();
  };
  EXPECT_LT(error_at_80(Update::lazy), 1.25 * error_at_80(Update::full));
  std::sort(order.begin(), order.end());
  for (std::uint32_t p = 0; p < set.size(); ++p) EXPECT_EQ(order[p], p);
}

TEST(GreedyRemoval, ErrorFromTheSumsIsTheErrorOfTheRetained) {
  const ObservationSet set = test::random_observations(500, 4, 9);
  auto table = neighbourhood_table(gme_grid(6), set.position_km, {120});
  const NeighbourhoodTable copy = *table;
  RemovalSums sums(std::move(*table), set.values, 4);
  const Retained retained = remove_greedily(sums, 50, Update::full);
  std::vector<std::uint8_t> mask(set.size());
  for (const std::uint32_t p : retained) mask[p] = 1;
  const EstimationError error = estimation_error(copy, set.values, 4, mask);
  EXPECT_NEAR(sums.error_sum() / static_cast<double>(copy.evaluation_point_count()), error.mean_squared_k2,
              1e-9 * error.mean_squared_k2);
}

}  // namespace
}  // namespace thin
