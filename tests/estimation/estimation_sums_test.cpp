#include "libthin/estimation/estimation_sums.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "libthin/estimation/gme_grid.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

// What the sums must be, from the retained alone.
void expect_sums(const EstimationSums& sums, const NeighbourhoodTable& table, const ObservationSet& set) {
  const std::size_t channels = set.channel_count();
  for (std::size_t q = 0; q < sums.evaluation_point_count(); ++q) {
    double weight_sum = 0, absolute_sum = 0;
    std::vector<double> value_sum(channels, 0.0);
    for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
      const std::uint32_t p = table.observation[entry];
      if (!sums.is_retained(p)) continue;
      weight_sum += table.weight[entry];
      for (std::size_t c = 0; c < channels; ++c) {
        value_sum[c] += table.weight[entry] * set.values[p * channels + c];
        absolute_sum += table.weight[entry] * std::abs(set.values[p * channels + c]);
      }
    }
    ASSERT_NEAR(sums.weight_sum(q), weight_sum, 1e-9 * weight_sum);
    for (std::size_t c = 0; c < channels; ++c) ASSERT_NEAR(sums.value_sum(q, c), value_sum[c], 1e-9 * absolute_sum);
  }
}

// Everything against a recomputation from the definition.
void expect_equal_to_oracle(EstimationSums& sums, const test::EstimationOracle& oracle, EstimationSums::Track track) {
  std::vector<bool> retained;
  for (std::uint32_t p = 0; p < sums.observation_count(); ++p) retained.push_back(sums.is_retained(p));
  const std::vector<double> increments = oracle.increments(retained);
  const double error = oracle.error_sum(retained);
  ASSERT_NEAR(sums.error_sum(), error, 1e-9 * (error + 1e-6));
  for (std::uint32_t p = 0; p < sums.observation_count(); ++p) {
    ASSERT_NEAR(sums.increment(p), increments[p], 1e-9 * (1 + error)) << p;
    const bool tracked = track == EstimationSums::Track::both ||
                         track == (retained[p] ? EstimationSums::Track::retained : EstimationSums::Track::given_up);
    if (tracked) {
      ASSERT_NEAR(sums.tracked_increment(p), increments[p], 1e-9 * (1 + error)) << p;
    }
  }
}

struct Setting {
  ObservationSet set;
  std::optional<std::vector<Vector3>> grid;  // the observations, where absent
  double bandwidth_km;

  NeighbourhoodTable table() const {
    const Places places = places_of(set);
    return grid ? *neighbourhood_table(places_at(*grid), places, {bandwidth_km})
                : *neighbourhood_table(places, {bandwidth_km});
  }
  test::EstimationOracle oracle() const {
    return {grid.value_or(set.position_km), set.position_km, set.values, set.channel_count(), bandwidth_km};
  }
};

using Start = EstimationSums::Start;
using Track = EstimationSums::Track;

// Changes states in a random order, and compares on the way.
void change_and_compare(const Setting& setting, Start start, Track track, const std::vector<std::uint32_t>& order,
                        std::size_t compare_every) {
  const NeighbourhoodTable table = setting.table();
  EstimationSums sums(table, setting.set.values, setting.set.channel_count(), start);
  sums.track(track);
  for (std::size_t step = 0; step < order.size(); ++step) {
    std::vector<double> before(setting.set.size());
    for (std::uint32_t p = 0; p < before.size(); ++p) before[p] = sums.tracked_increment(p);
    sums.change_state(order[step]);
    for (std::uint32_t p = 0; p < before.size(); ++p)  // what was not reported did not fall
      if (p != order[step] && std::ranges::find(sums.fallen(), p) == sums.fallen().end()) {
        ASSERT_GE(sums.tracked_increment(p), before[p]);
      }
    if (step % compare_every != 0 && step + 3 < order.size()) continue;
    SCOPED_TRACE(step);
    expect_sums(sums, table, setting.set);
    expect_equal_to_oracle(sums, setting.oracle(), track);
    if (testing::Test::HasFatalFailure()) return;
  }
}

std::vector<std::uint32_t> each_once(std::size_t n, unsigned seed) {
  std::vector<std::uint32_t> order(n);
  for (std::uint32_t p = 0; p < n; ++p) order[p] = p;
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

std::vector<std::uint32_t> any_often(std::size_t n, std::size_t steps, unsigned seed) {
  std::vector<std::uint32_t> order;
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < steps; ++i) order.push_back(static_cast<std::uint32_t>(random() % n));
  return order;
}

TEST(EstimationSums, AgreeWithRecomputationAtTheObservations) {
  for (const std::size_t channels : {1U, 4U, 5U, 8U, 17U}) {
    SCOPED_TRACE(channels);
    const Setting setting{test::random_observations(60, channels, 10), std::nullopt, 200};
    change_and_compare(setting, Start::with_all, Track::retained, each_once(60, 1), 9);
    change_and_compare(setting, Start::with_none, Track::given_up, each_once(60, 2), 9);
    change_and_compare(setting, Start::with_all, Track::both, any_often(60, 100, 3), 9);
  }
}

TEST(EstimationSums, AgreeWithRecomputationOnTheGrid) {
  const Setting setting{test::random_observations(70, 3, 11, {70, 90, 0, 360}), gme_grid(4), 250};
  change_and_compare(setting, Start::with_all, Track::retained, each_once(70, 4), 9);
  change_and_compare(setting, Start::with_none, Track::given_up, each_once(70, 5), 9);
  change_and_compare(setting, Start::with_none, Track::both, any_often(70, 150, 6), 9);
}

TEST(EstimationSums, KnowWhatASwapWouldAdd) {
  for (const bool on_grid : {false, true}) {
    const Setting setting{test::random_observations(80, 5, 12), on_grid ? std::optional(gme_grid(5)) : std::nullopt,
                          150};
    EstimationSums sums(setting.table(), setting.set.values, 5, Start::with_none);
    for (std::uint32_t p = 0; p < 80; p += 4) sums.change_state(p);
    for (std::uint32_t out = 0; out < 80; out += 4)
      for (const std::uint32_t in : {out + 1, (out + 33) % 80 / 4 * 4 + 2}) {
        const double before = sums.error_sum(), added = sums.swap_increment(out, in);
        sums.change_state(out);
        sums.change_state(in);
        EXPECT_NEAR(sums.error_sum(), before + added, 1e-9 * before) << out << " for " << in;
        sums.change_state(in);
        sums.change_state(out);
      }
  }
}

// Thousands of observations on one spot: large weights go, small ones stay.
TEST(EstimationSums, SurviveTheRemovalOfNearlyAllWeight) {
  ObservationSet set = test::random_observations(1200, 2, 12, {0, 0.01, 0, 0.01});
  const ObservationSet far = test::random_observations(3, 2, 13, {2.69, 2.70, 0, 0.1});  // just within 3h of the spot
  set.append(far);
  const std::vector<Vector3> points = {set.position_km[0]};
  const NeighbourhoodTable table = *neighbourhood_table(places_at(points), places_of(set), {100});
  ASSERT_EQ(table.entry_count(), set.size());
  EstimationSums sums(table, set.values, 2, Start::with_all);
  for (std::uint32_t p = 0; p < 1200; ++p) sums.change_state(p);
  EXPECT_LT(sums.weight_sum(0), 1e-3);
  expect_sums(sums, table, set);
}

// One place gains and loses the same observations over and over.
TEST(EstimationSums, DoNotDriftOverManyChanges) {
  const Setting setting{test::random_observations(40, 2, 14), std::nullopt, 150};
  const NeighbourhoodTable table = setting.table();
  EstimationSums sums(table, setting.set.values, 2, Start::with_all);
  sums.track(Track::both);
  for (const std::uint32_t p : any_often(40, 20000, 15)) sums.change_state(p);
  expect_sums(sums, table, setting.set);
  expect_equal_to_oracle(sums, setting.oracle(), Track::both);
}

TEST(EstimationSums, KnowWhatChangedSince) {
  const ObservationSet set = test::random_observations(50, 1, 14);
  EstimationSums sums(*neighbourhood_table(places_of(set), {100}), set.values, 1, Start::with_all);
  sums.change_state(0);
  EXPECT_TRUE(sums.changed_since(0, 0));
  EXPECT_FALSE(sums.changed_since(0, 1));
}

}  // namespace
}  // namespace thin
