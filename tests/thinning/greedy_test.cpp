#include "libthin/thinning/greedy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libthin/estimation/estimation_error.h"
#include "libthin/estimation/gme_grid.h"
#include "libthin/observations/geodesy.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

using Start = EstimationSums::Start;

// The observations as evaluation points, where no grid is given.
NeighbourhoodTable table_of(const ObservationSet& set, const std::vector<Vector3>* grid, double bandwidth_km) {
  const Places places = places_of(set);
  return grid ? *neighbourhood_table(places_at(*grid), places, {bandwidth_km})
              : *neighbourhood_table(places, {bandwidth_km});
}

std::vector<std::uint32_t> greedy_order(const ObservationSet& set, const std::vector<Vector3>* grid,
                                        double bandwidth_km, Start start, Update update, GreedyGoal goal = {}) {
  EstimationSums sums(table_of(set, grid, bandwidth_km), set.values, set.channel_count(), start);
  std::vector<std::uint32_t> order;
  if (start == Start::with_all) {
    remove_greedily(sums, goal, update, &order);
  } else {
    goal.retain_count = set.size();
    insert_greedily(sums, goal, update, &order);
  }
  return order;
}

// Each step of full updating takes the true minimum: every increment recomputed from the definition.
void expect_every_step_is_the_minimum(const ObservationSet& set, const std::vector<Vector3>* grid, double bandwidth_km,
                                      Start start) {
  const test::EstimationOracle oracle{grid ? *grid : set.position_km, set.position_km, set.values, set.channel_count(),
                                      bandwidth_km};
  const bool at_first = start == Start::with_all;
  std::vector<bool> retained(set.size(), at_first);
  const std::vector<std::uint32_t> order = greedy_order(set, grid, bandwidth_km, start, Update::full);
  EXPECT_EQ(order.size(), set.size());
  for (const std::uint32_t chosen : order) {
    const std::vector<double> increments = oracle.increments(retained);
    ASSERT_EQ(retained[chosen], at_first);
    const double tolerance = 1e-10 * (1 + oracle.error_sum(retained));
    for (std::size_t p = 0; p < set.size(); ++p) {
      if (retained[p] != at_first) continue;
      ASSERT_LE(increments[chosen], increments[p] + tolerance) << chosen << " was taken before " << p;
    }
    retained[chosen] = !at_first;
  }
}

class Greedy : public testing::TestWithParam<Start> {};

INSTANTIATE_TEST_SUITE_P(Ways, Greedy, testing::Values(Start::with_all, Start::with_none),
                         [](const auto& each) { return each.param == Start::with_all ? "Removal" : "Insertion"; });

TEST_P(Greedy, TakesTheTrueMinimumOnTheGrid) {
  const std::vector<Vector3> grid = gme_grid(4);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    expect_every_step_is_the_minimum(test::random_observations(60, 1 + seed, seed), &grid, 250, GetParam());
  }
}

TEST_P(Greedy, TakesTheTrueMinimumAtTheObservations) {
  expect_every_step_is_the_minimum(test::random_observations(50, 2, 5), nullptr, 150, GetParam());
}

TEST_P(Greedy, TakesTheTrueMinimumAroundThePole) {
  const std::vector<Vector3> grid = gme_grid(5);
  expect_every_step_is_the_minimum(test::random_observations(60, 2, 6, {85, 90, 0, 360}), &grid, 150, GetParam());
}

TEST_P(Greedy, TakesEqualOnesByIndex) {
  ObservationSet set = test::random_observations(20, 1, 7);
  std::fill(set.values.begin(), set.values.end(), 0.0);
  std::vector<std::uint32_t> expected(20);
  for (std::uint32_t p = 0; p < 20; ++p) expected[p] = p;
  EXPECT_EQ(greedy_order(set, nullptr, 100, GetParam(), Update::full), expected);
}

TEST_P(Greedy, LazyTakesEachOnceAndComesClose) {
  const ObservationSet set = test::random_observations(800, 3, 8);
  const std::vector<Vector3> grid = gme_grid(6);
  // Insertion needs a small bandwidth: what an observation alone in a wide reach does wrong, later ones make right, and
  // falling increments are what lazy updating doesn't see.
  const double bandwidth_km = GetParam() == Start::with_all ? 150 : 50;
  std::vector<std::uint32_t> order = greedy_order(set, &grid, bandwidth_km, GetParam(), Update::lazy);
  const auto error_at_80 = [&](Update update) {
    EstimationSums sums(table_of(set, &grid, bandwidth_km), set.values, 3, GetParam());
    if (GetParam() == Start::with_all)
      remove_greedily(sums, {.retain_count = 80}, update);
    else
      insert_greedily(sums, {.retain_count = 80}, update);
    EXPECT_EQ(sums.retained_count(), 80U);
    return sums.error_sum();
  };
  EXPECT_LT(error_at_80(Update::lazy), 1.25 * error_at_80(Update::full));
  std::sort(order.begin(), order.end());
  for (std::uint32_t p = 0; p < set.size(); ++p) EXPECT_EQ(order[p], p);
}

TEST_P(Greedy, TakesByPriorityFirst) {
  const ObservationSet set = test::random_observations(60, 1, 9);
  std::vector<double> priority(60);
  for (std::size_t p = 0; p < 60; ++p) priority[p] = static_cast<double>(p % 3);
  const GreedyGoal goal{.priority = priority};
  for (const Update update : {Update::full, Update::lazy}) {
    const std::vector<std::uint32_t> order = greedy_order(set, nullptr, 150, GetParam(), update, goal);
    ASSERT_EQ(order.size(), 60U);
    for (std::size_t i = 0; i < 60; ++i)
      EXPECT_EQ(priority[order[i]], GetParam() == Start::with_all ? i / 20 : 2 - i / 20) << i;
  }
}

TEST_P(Greedy, KeepsTheRetainedApart) {
  const ObservationSet set = test::random_observations(500, 2, 10);
  const Separation separation(set.position_km, 120);
  EstimationSums sums(table_of(set, nullptr, 100), set.values, 2, GetParam());
  const GreedyGoal goal{.retain_count = 120, .separation = &separation};
  if (GetParam() == Start::with_all)
    remove_greedily(sums, goal, Update::full);
  else
    insert_greedily(sums, goal, Update::full);
  EXPECT_GT(sums.retained_count(), 60U);
  EXPECT_LE(sums.retained_count(), 120U);
  for (const std::uint32_t p : sums.retained())
    for (const std::uint32_t q : sums.retained())
      if (p != q) {
        EXPECT_GE(chord_km(set.position_km[p], set.position_km[q]), 120);
      }
}

TEST_P(Greedy, StopsAtTheErrorAskedFor) {
  const ObservationSet set = test::random_observations(300, 2, 11);
  EstimationSums sums(table_of(set, nullptr, 150), set.values, 2, GetParam());
  const bool removal = GetParam() == Start::with_all;
  const double limit =
      0.2 * (removal ? EstimationSums(table_of(set, nullptr, 150), set.values, 2, Start::with_none).error_sum()
                     : sums.error_sum());
  const GreedyGoal goal{.retain_count = removal ? 0U : 300U, .error_sum = limit};
  if (removal)
    remove_greedily(sums, goal, Update::full);
  else
    insert_greedily(sums, goal, Update::full);
  EXPECT_LE(sums.error_sum(), limit * (1 + 1e-9));
  EXPECT_GT(sums.retained_count(), 0U);
  EXPECT_LT(sums.retained_count(), 300U);
  if (!removal) return;
  // One more would pass it.
  double least = 1e300;
  for (const std::uint32_t p : sums.retained()) least = std::min(least, sums.increment(p));
  EXPECT_GT(sums.error_sum() + least, limit);
}

TEST(GreedyRemoval, ErrorFromTheSumsIsTheErrorOfTheRetained) {
  const ObservationSet set = test::random_observations(500, 4, 9);
  const std::vector<Vector3> grid = gme_grid(6);
  const NeighbourhoodTable table = table_of(set, &grid, 120);
  EstimationSums sums(table, set.values, 4, Start::with_all);
  remove_greedily(sums, {.retain_count = 50}, Update::full);
  std::vector<std::uint8_t> mask(set.size());
  for (const std::uint32_t p : sums.retained()) mask[p] = 1;
  const EstimationError error = estimation_error(table, set.values, 4, mask);
  EXPECT_NEAR(sums.error_sum() / static_cast<double>(table.evaluation_point_count()), error.mean_squared_k2,
              1e-9 * error.mean_squared_k2);
}

}  // namespace
}  // namespace thin
