#include "libthin/thinning/analysis_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libthin/estimation/analysis_target.h"
#include "libthin/observations/geodesy.h"
#include "libthin/thinning/greedy.h"
#include "libthin/thinning/refinement.h"
#include "tests/support/local_analysis_oracle.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

constexpr double kLengthKm = 250;
constexpr AnalysisModel kModel = {.covariance = {kLengthKm, false}, .error_ratio = 0.4, .coverage = 0.1};

struct Scene {
  ObservationSet set;
  Places places;
  std::vector<std::uint32_t> points;
  std::vector<double> targets;

  Scene(std::size_t count, std::size_t channels, unsigned seed, double spacing_km)
      : set(test::random_observations(count, channels, seed)),
        places(places_of(set)),
        points(spread_places(places, spacing_km)),
        targets(filter_estimates(places, set.values, channels, points, {kLengthKm / 2})) {}

  LocalAnalysis sparse() const { return {places, set.values, set.channel_count(), points, targets, kModel}; }
  test::LocalAnalysisOracle dense() const {
    test::LocalAnalysisOracle oracle(places, set.values, set.channel_count(), kLengthKm, false);
    oracle.points = points;
    oracle.targets = targets;
    oracle.error_ratio = kModel.error_ratio;
    oracle.coverage = kModel.coverage;
    return oracle;
  }
};

class AnalysisScene : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(EvaluationSpacings, AnalysisScene, testing::Values(0, 150));

TEST_P(AnalysisScene, EveryStepOfTheInsertionIsTheTrueMinimum) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(45, seed, seed, GetParam());
    LocalAnalysis analysis = scene.sparse();
    test::LocalAnalysisOracle oracle = scene.dense();
    std::vector<std::uint32_t> order;
    insert_greedily(analysis, {.retain_count = 30}, Update::full, &order);
    ASSERT_EQ(order.size(), 30U);
    for (const std::uint32_t chosen : order) {
      const std::vector<double> increments = oracle.increments();
      for (std::uint32_t p = 0; p < oracle.n; ++p)
        if (!oracle.retained[p]) {
          ASSERT_LE(increments[chosen], increments[p] + 1e-9 * (1 + oracle.j())) << chosen << " before " << p;
        }
      oracle.change_state(chosen);
    }
    EXPECT_NEAR(analysis.error_sum(), oracle.j(), 1e-9 * oracle.j());
  }
}

TEST_P(AnalysisScene, ExchangeLowersJTillNoBestPairDoes) {
  std::size_t swaps = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene(45, 2, seed, GetParam());
    LocalAnalysis analysis = scene.sparse();
    for (std::uint32_t p = 0; p < 12; ++p) analysis.change_state(p);
    const double before = analysis.error_sum();
    swaps += exchange(analysis, {}, 1e-9);
    EXPECT_LE(analysis.error_sum(), before);
    EXPECT_EQ(analysis.retained_count(), 12U);
    // The best insertion with the best removal after it, and the other way round: neither helps.
    const auto cheapest = [&](bool retained) {
      std::uint32_t best = 0;
      double least = 1e300;
      for (std::uint32_t p = 0; p < analysis.observation_count(); ++p)
        if (analysis.is_retained(p) == retained && analysis.tracked_increment(p) < least)
          best = p, least = analysis.tracked_increment(p);
      return std::pair(best, least);
    };
    for (const bool removal_first : {false, true}) {
      const auto [first, change] = cheapest(removal_first);
      analysis.change_state(first);
      EXPECT_GE(change + cheapest(!removal_first).second, -1e-6 * before);
      analysis.change_state(first);
    }
  }
  EXPECT_GT(swaps, 4U);
}

TEST(AnalysisThinning, ExchangeIsNoWorseThanWithoutIt) {
  // By J of the set it ends with, retained in canonical order, to what the cut-off leaves open.
  const Scene scene(600, 2, 7, 100);
  const auto j_of = [&](bool exchange) {
    const Thinner thinner = test::thinner("analysis", {{"retain_count", std::int64_t{60}},
                                                       {"correlation_length_km", kLengthKm},
                                                       {"gross_error_check", 0.0},
                                                       {"error_ratio", kModel.error_ratio},
                                                       {"exchange", exchange}});
    LocalAnalysis analysis = scene.sparse();
    for (const std::uint32_t p : test::retained(thinner, scene.set)) analysis.change_state(p);
    return analysis.error_sum();
  };
  EXPECT_LT(j_of(true), 1.01 * j_of(false));
}

TEST(AnalysisThinning, LeavesOutWhatItsNeighboursContradict) {
  ObservationSet set = test::random_observations(1500, 1, 8);
  std::vector<std::uint32_t> wrong;
  for (std::uint32_t i = 50; i < set.size(); i += 100) {
    set.values[i] += i % 200 == 50 ? 6 : -6;
    wrong.push_back(i);
  }
  // Even where all are asked for.
  const auto retained_with = [&](double check) {
    return test::retained(test::thinner("analysis", {{"retain_count", std::int64_t{1500}},
                                                     {"correlation_length_km", 200.0},
                                                     {"gross_error_check", check}}),
                          set);
  };
  EXPECT_EQ(retained_with(0).size(), 1500U);
  const Retained retained = retained_with(4);
  EXPECT_GT(retained.size(), 1450U);
  for (const std::uint32_t i : wrong) EXPECT_FALSE(std::binary_search(retained.begin(), retained.end(), i));
}

TEST(AnalysisThinning, IsNotDrawnToOutliersEvenWhenItBelievesThem) {
  ObservationSet set = test::random_observations(1500, 1, 8);
  for (std::uint32_t i = 50; i < set.size(); i += 100) set.values[i] += i % 200 == 50 ? 6 : -6;
  std::size_t outliers = 0;
  for (const std::uint32_t i : test::retained(test::thinner("analysis", {{"retain_count", std::int64_t{150}},
                                                                         {"correlation_length_km", 200.0},
                                                                         {"gross_error_check", 0.0}}),
                                              set))
    outliers += i % 100 == 50;
  EXPECT_LE(outliers, 1U);
}

TEST(AnalysisThinning, IsDenseWhereTheFirstGuessIsWrong) {
  // Waves in the west, nothing in the east.
  ObservationSet set = test::random_observations(4000, 1, 13, {-10, 10, 0, 40});
  for (std::size_t i = 0; i < set.size(); ++i)
    set.values[i] = set.longitude_deg[i] < 20 ? std::sin(set.longitude_deg[i]) * std::sin(set.latitude_deg[i]) : 0;
  const auto in_the_west = [&](double coverage_weight) {
    std::size_t west = 0;
    for (const std::uint32_t i : test::retained(test::thinner("analysis", {{"retain_count", std::int64_t{200}},
                                                                           {"correlation_length_km", 150.0},
                                                                           {"gross_error_check", 0.0},
                                                                           {"coverage_weight", coverage_weight}}),
                                                set))
      west += set.longitude_deg[i] < 20;
    return west;
  };
  EXPECT_GT(in_the_west(0), 150U);
  EXPECT_GT(in_the_west(0.2), 110U);
  EXPECT_LT(in_the_west(100), 110U);  // coverage alone
}

TEST(AnalysisThinning, HeedsPriorityAndSeparation) {
  ObservationSet set = test::random_observations(600, 1, 9);
  for (std::size_t i = 0; i < set.size(); ++i) set.variables["good"].push_back(i % 10 == 0);
  const Retained retained = test::retained(test::thinner("analysis", {{"retain_count", std::int64_t{100}},
                                                                      {"correlation_length_km", 250.0},
                                                                      {"gross_error_check", 0.0},
                                                                      {"min_separation_km", 90.0},
                                                                      {"priority_variable", std::string("good")}}),
                                           set);
  EXPECT_GT(retained.size(), 60U);
  std::size_t good = 0;
  for (const std::uint32_t i : retained) {
    good += i % 10 == 0;
    for (const std::uint32_t j : retained)
      if (i != j) {
        EXPECT_GE(chord_km(set.position_km[i], set.position_km[j]), 90);
      }
  }
  EXPECT_GT(good, 40U);
}

TEST(AnalysisThinning, TakesOffABiasAndSaysSo) {
  ObservationSet set = test::random_observations(500, 2, 10);
  const Thinner thinner = test::thinner("analysis", {{"retain_count", std::int64_t{50}}});
  const Result<Choice> plain = thinner.thin(set);
  for (std::size_t i = 0; i < set.size(); ++i) set.values[2 * i + 1] += 64;  // exact, so that nothing else changes much
  const Result<Choice> biased = thinner.thin(set);
  ASSERT_TRUE(plain && biased);
  const auto speaks_of_bias = [](const Choice& choice) {
    return std::any_of(choice.notes.begin(), choice.notes.end(),
                       [](const std::string& note) { return note.find("channel 2: a mean of") != std::string::npos; });
  };
  EXPECT_FALSE(speaks_of_bias(*plain));
  EXPECT_TRUE(speaks_of_bias(*biased));
  std::vector<std::uint32_t> both;
  std::set_intersection(plain->retained.begin(), plain->retained.end(), biased->retained.begin(),
                        biased->retained.end(), std::back_inserter(both));
  EXPECT_GT(both.size(), 25U);
}

}  // namespace
}  // namespace thin
