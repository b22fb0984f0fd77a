#include "libthin/thinning/refinement.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libthin/observations/geodesy.h"
#include "libthin/thinning/greedy.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

EstimationSums greedy_set(const ObservationSet& set, std::size_t count, double bandwidth_km,
                          const Separation* separation = nullptr) {
  EstimationSums sums(*neighbourhood_table(places_of(set), {bandwidth_km}), set.values, set.channel_count(),
                      EstimationSums::Start::with_all);
  remove_greedily(sums, {.retain_count = count, .separation = separation}, Update::full);
  return sums;
}

TEST(Exchange, LowersTheErrorAndKeepsTheNumber) {
  const ObservationSet set = test::random_observations(600, 2, 1);
  EstimationSums sums = greedy_set(set, 80, 120);
  const double before = sums.error_sum();
  exchange(sums, {});
  EXPECT_EQ(sums.retained_count(), 80U);
  EXPECT_LT(sums.error_sum(), 0.98 * before);
}

// Where it stops, neither the best insertion followed by the best removal nor the reverse gains anything.
TEST(Exchange, EndsWhereTheOracleFindsNoBetterPair) {
  const ObservationSet set = test::random_observations(60, 1, 2);
  EstimationSums sums = greedy_set(set, 12, 200);
  exchange(sums, {});
  const test::EstimationOracle oracle{set.position_km, set.position_km, set.values, 1, 200};
  std::vector<bool> retained(60);
  for (const std::uint32_t p : sums.retained()) retained[p] = true;
  const double error = oracle.error_sum(retained);
  for (const bool insertion_first : {true, false}) {
    std::vector<bool> now = retained;
    for (const bool wanted : {!insertion_first, insertion_first}) {
      const std::vector<double> increments = oracle.increments(now);
      std::size_t best = 60;
      for (std::size_t p = 0; p < 60; ++p)
        if (now[p] == wanted && (best == 60 || increments[p] < increments[best])) best = p;
      now[best] = !now[best];
    }
    EXPECT_GE(oracle.error_sum(now), error * (1 - 1e-9)) << insertion_first;
  }
}

TEST(Annealing, LowersTheErrorFurther) {
  const ObservationSet set = test::random_observations(800, 2, 3);
  EstimationSums exchanged = greedy_set(set, 100, 120), annealed = greedy_set(set, 100, 120);
  exchange(exchanged, {});
  refine(annealed, {}, {.refine = Refinement::annealing});
  EXPECT_EQ(annealed.retained_count(), 100U);
  EXPECT_LT(annealed.error_sum(), 0.95 * exchanged.error_sum());
}

TEST(Annealing, IsTheSameForTheSameSeed) {
  const ObservationSet set = test::random_observations(400, 2, 4);
  const auto retained = [&](std::int64_t seed) {
    return test::retained(
        test::thinner("grid_eea",
                      {{"retain_count", std::int64_t{50}}, {"refine", std::string("annealing")}, {"seed", seed}}),
        set);
  };
  EXPECT_EQ(retained(1), retained(1));
  EXPECT_NE(retained(1), retained(2));
}

TEST(Annealing, NeverEndsAboveItsBeginning) {
  // Hot enough to lose everything in so few trials.
  const ObservationSet set = test::random_observations(300, 1, 5);
  EstimationSums sums = greedy_set(set, 40, 150);
  exchange(sums, {});
  const double before = sums.error_sum();
  anneal(sums, {}, 50, 1);
  EXPECT_LE(sums.error_sum(), before * (1 + 1e-9));
  EXPECT_EQ(sums.retained_count(), 40U);
}

TEST(Refinement, StartsFromRandomSetsTooAndTakesTheBest) {
  const ObservationSet set = test::random_observations(400, 1, 6);
  EstimationSums one = greedy_set(set, 60, 120), many = greedy_set(set, 60, 120);
  refine(one, {}, {.refine = Refinement::exchange});
  refine(many, {}, {.refine = Refinement::exchange, .starts = 6});
  EXPECT_LE(many.error_sum(), one.error_sum() * (1 + 1e-9));
  EXPECT_EQ(many.retained_count(), 60U);
}

TEST(Refinement, RespectsPriorityAndSeparation) {
  const ObservationSet set = test::random_observations(400, 2, 7);
  const Separation separation(set.position_km, 100);
  std::vector<double> priority(400, 0.0);
  for (std::size_t p = 0; p < 400; p += 20) priority[p] = 1;
  for (const Refinement kind : {Refinement::exchange, Refinement::annealing}) {
    EstimationSums sums(*neighbourhood_table(places_of(set), {120}), set.values, 2, EstimationSums::Start::with_all);
    remove_greedily(sums, {.retain_count = 60, .priority = priority, .separation = &separation}, Update::full);
    const auto important = [&] {
      std::vector<std::uint32_t> result = sums.retained();
      std::erase_if(result, [&](std::uint32_t p) { return priority[p] == 0; });
      return result.size();
    };
    const std::size_t before = important();
    refine(sums, {.priority = priority, .separation = &separation}, {.refine = kind, .starts = 2});
    EXPECT_GE(important(), before);
    for (const std::uint32_t p : sums.retained())
      for (const std::uint32_t q : separation.too_near_to(p)) EXPECT_FALSE(sums.is_retained(q));
  }
}

TEST(Refinement, TakesNothingAndEverything) {
  const ObservationSet set = test::random_observations(50, 1, 8);
  for (const std::size_t count : {0U, 1U, 50U})
    for (const Refinement kind : {Refinement::exchange, Refinement::annealing}) {
      EstimationSums sums = greedy_set(set, count, 120);
      refine(sums, {}, {.refine = kind, .starts = 2});
      EXPECT_EQ(sums.retained_count(), count);
    }
}

}  // namespace
}  // namespace thin
