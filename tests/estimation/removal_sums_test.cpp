#include "libthin/estimation/removal_sums.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libthin/estimation/gme_grid.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

// Removes in random order down to nothing, and compares sums, increments and error with a recomputation on the way.
void remove_all_and_compare(const ObservationSet& set, const std::vector<Vector3>& points, double bandwidth_km,
                            std::size_t compare_every, unsigned seed) {
  const std::size_t channels = set.channel_count();
  std::vector<std::uint32_t> kept;
  auto table = neighbourhood_table(points, set.position_km, {bandwidth_km}, &kept);
  ASSERT_TRUE(table);
  const NeighbourhoodTable copy = *table;
  RemovalSums sums(std::move(*table), set.values, channels);
  sums.track_increments();
  const test::EstimationOracle oracle{points, set.position_km, set.values, channels, bandwidth_km};

  std::vector<std::uint32_t> order(set.size());
  for (std::uint32_t p = 0; p < order.size(); ++p) order[p] = p;
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<bool> retained(set.size(), true);
  std::vector<std::uint32_t> changed;
  for (std::size_t step = 0; step < order.size(); ++step) {
    std::vector<double> before(set.size());
    for (std::uint32_t p = 0; p < set.size(); ++p) before[p] = sums.is_retained(p) ? sums.tracked_increment(p) : 0;
    changed.clear();
    sums.remove(order[step], &changed);
    retained[order[step]] = false;
    for (std::uint32_t p = 0; p < set.size(); ++p)  // what was not reported did not change
      if (retained[p] && std::find(changed.begin(), changed.end(), p) == changed.end()) {
        ASSERT_EQ(sums.tracked_increment(p), before[p]);
      }
    if (step % compare_every != 0 && step + 3 < order.size()) continue;

    for (std::size_t q = 0; q < sums.evaluation_point_count(); ++q) {
      double weight_sum = 0, absolute_sum = 0;
      std::vector<double> value_sum(channels, 0.0);
      for (std::uint64_t entry = copy.row_begin[q]; entry < copy.row_begin[q + 1]; ++entry) {
        if (!retained[copy.observation[entry]]) continue;
        weight_sum += copy.weight[entry];
        for (std::size_t c = 0; c < channels; ++c) {
          value_sum[c] += copy.weight[entry] * set.values[copy.observation[entry] * channels + c];
          absolute_sum += copy.weight[entry] * std::abs(set.values[copy.observation[entry] * channels + c]);
        }
      }
      ASSERT_NEAR(sums.weight_sum(q), weight_sum, 1e-9 * weight_sum);
      for (std::size_t c = 0; c < channels; ++c) ASSERT_NEAR(sums.value_sum(q, c), value_sum[c], 1e-9 * absolute_sum);
    }
    const std::vector<double> increments = oracle.increments(retained);
    const double error = oracle.error_sum(retained);
    ASSERT_NEAR(sums.error_sum(), error, 1e-9 * (error + 1e-6));
    for (std::uint32_t p = 0; p < set.size(); ++p) {
      if (!retained[p]) continue;
      ASSERT_NEAR(sums.tracked_increment(p), increments[p], 1e-9 * (1 + error)) << "step " << step;
      ASSERT_NEAR(sums.tracked_increment(p), sums.increment(p), 1e-12 * (1 + error));
    }
  }
}

TEST(RemovalSums, AgreeWithRecomputationAtTheObservations) {
  for (const std::size_t channels : {1U, 4U, 5U, 8U, 17U}) {
    SCOPED_TRACE(channels);
    const ObservationSet set = test::random_observations(60, channels, 10);
    remove_all_and_compare(set, set.position_km, 200, 9, 1);
  }
}

TEST(RemovalSums, AgreeWithRecomputationOnTheGrid) {
  const ObservationSet set = test::random_observations(70, 3, 11, {70, 90, 0, 360});
  remove_all_and_compare(set, gme_grid(4), 250, 9, 2);
}

// Thousands of observations on one spot: large weights go, small ones stay.
TEST(RemovalSums, SurviveTheRemovalOfNearlyAllWeight) {
  ObservationSet set = test::random_observations(1200, 2, 12, {0, 0.01, 0, 0.01});
  const ObservationSet far = test::random_observations(3, 2, 13, {2.69, 2.70, 0, 0.1});  // just within 3h of the spot
  set.append(far);
  const std::vector<Vector3> points = {set.position_km[0]};
  auto table = neighbourhood_table(points, set.position_km, {100});
  const NeighbourhoodTable copy = *table;
  ASSERT_EQ(copy.entry_count(), set.size());
  RemovalSums sums(std::move(*table), set.values, 2);
  for (std::uint32_t p = 0; p < 1200; ++p) sums.remove(p);
  double weight_sum = 0, value_sum = 0;
  for (std::uint32_t entry = 1200; entry < 1203; ++entry) {
    weight_sum += copy.weight[entry];
    value_sum += copy.weight[entry] * set.values[entry * 2];
  }
  EXPECT_LT(weight_sum, 1e-3);
  EXPECT_NEAR(sums.weight_sum(0), weight_sum, 1e-9 * weight_sum);
  EXPECT_NEAR(sums.value_sum(0, 0), value_sum, 1e-9 * std::abs(value_sum));
}

TEST(RemovalSums, KnowWhatChangedSince) {
  const ObservationSet set = test::random_observations(50, 1, 14);
  auto table = neighbourhood_table(set.position_km, set.position_km, {100});
  RemovalSums sums(std::move(*table), set.values, 1);
  sums.remove(0);
  EXPECT_TRUE(sums.changed_since(0, 0));
  EXPECT_FALSE(sums.changed_since(0, 1));
}

}  // namespace
}  // namespace thin
