#include "libthin/estimation/local_analysis.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/local_analysis_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

struct Setting {
  std::size_t count, channels;
  double length_km;
  bool two_scales = false;
  std::uint32_t stride = 1;  // one observation in so many is an evaluation point
  double time_scale_km_per_hour = 0;
};

class LocalAnalysisTest : public testing::TestWithParam<Setting> {
 protected:
  LocalAnalysisTest()
      : set(test::random_observations(GetParam().count, GetParam().channels, 3)),
        places(places_of(set, GetParam().time_scale_km_per_hour)) {
    for (std::uint32_t p = 0; p < set.size(); p += GetParam().stride) points.push_back(p);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < points.size() * GetParam().channels; ++i) targets.push_back(normal(random));
  }

  test::LocalAnalysisOracle oracle() const {
    test::LocalAnalysisOracle oracle(places, set.values, GetParam().channels, GetParam().length_km,
                                     GetParam().two_scales);
    oracle.points = points;
    oracle.targets = targets;
    oracle.error_ratio = 0.4;
    oracle.coverage = 0.3;
    return oracle;
  }
  LocalAnalysis sparse() const {
    return {places,
            set.values,
            GetParam().channels,
            points,
            targets,
            {.covariance = {GetParam().length_km, GetParam().two_scales}, .error_ratio = 0.4, .coverage = 0.3}};
  }

  static void expect_same(const LocalAnalysis& sparse, const test::LocalAnalysisOracle& oracle) {
    EXPECT_NEAR(sparse.error_sum(), oracle.j(), 1e-9 * oracle.j());
    const std::vector<double> increments = oracle.increments();
    for (std::uint32_t p = 0; p < oracle.n; ++p) {
      ASSERT_EQ(sparse.is_retained(p), oracle.retained[p]);
      ASSERT_NEAR(sparse.variance(p), oracle.covariance[p][p], 1e-9) << p;
      for (std::size_t c = 0; c < oracle.channels; ++c)
        ASSERT_NEAR(sparse.departure(p, c), oracle.values[p * oracle.channels + c] - oracle.analysis[p][c], 1e-9) << p;
      ASSERT_NEAR(sparse.tracked_increment(p), increments[p], 1e-9 * (1 + oracle.j())) << p;
    }
  }

  std::mt19937 random{5};
  ObservationSet set;
  Places places;
  std::vector<std::uint32_t> points;
  std::vector<double> targets;
};

INSTANTIATE_TEST_SUITE_P(Settings, LocalAnalysisTest,
                         testing::Values(Setting{60, 1, 150}, Setting{60, 3, 150}, Setting{50, 9, 300, true},
                                         Setting{60, 1, 200, false, 4}, Setting{60, 2, 120, true, 3},
                                         Setting{60, 1, 200, false, 2, 100000}));

TEST_P(LocalAnalysisTest, IsThatOfWholeMatricesThroughInsertionsAndRemovals) {
  LocalAnalysis analysis = sparse();
  test::LocalAnalysisOracle whole = oracle();
  expect_same(analysis, whole);
  std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(set.size() - 1));
  for (int change = 0; change < 30; ++change) {
    const std::uint32_t p = any(random);
    // The fallen are those that fell.
    std::vector<double> before;
    for (std::uint32_t i = 0; i < set.size(); ++i) before.push_back(analysis.tracked_increment(i));
    analysis.change_state(p);
    std::vector<std::uint32_t> fell;
    for (std::uint32_t i = 0; i < set.size(); ++i)
      if (analysis.tracked_increment(i) < before[i]) fell.push_back(i);
    std::vector<std::uint32_t> fallen(analysis.fallen().begin(), analysis.fallen().end());
    std::sort(fallen.begin(), fallen.end());
    ASSERT_EQ(fallen, fell);
    whole.change_state(p);
    expect_same(analysis, whole);
  }
  EXPECT_GT(analysis.retained_count(), 5U);
}

TEST_P(LocalAnalysisTest, GivingUpTheLastOneUndoesIt) {
  LocalAnalysis analysis = sparse();
  for (const std::uint32_t p : {7U, 20U, 33U}) analysis.change_state(p);
  const double before = analysis.error_sum();
  const std::vector<double> increment = {analysis.tracked_increment(8), analysis.tracked_increment(33)};
  analysis.change_state(8);
  EXPECT_NEAR(analysis.error_sum() - before, increment[0], 1e-9 * before);
  EXPECT_NEAR(analysis.tracked_increment(8), -increment[0], 1e-9 * before);
  analysis.change_state(8);
  EXPECT_NEAR(analysis.error_sum(), before, 1e-9 * before);
  EXPECT_NEAR(analysis.tracked_increment(8), increment[0], 1e-9 * before);
  EXPECT_NEAR(analysis.tracked_increment(33), increment[1], 1e-9 * before);
}

// The cut-off makes of B no true covariance: that must not show where as many are retained as anyone would.
TEST(LocalAnalysis, VariancesStayAboveNothing) {
  struct Case {
    std::size_t count;  // 3, 6.5, 8 and 11 in an area of L²
    BackgroundCovariance covariance;
  };
  for (const Case& each :
       {Case{240, {250, false}}, Case{510, {250, false, 3.25}}, Case{630, {250, false, 3.5}}, Case{900, {250, true}}}) {
    const ObservationSet set = test::random_observations(each.count, 1, 6);
    std::vector<std::uint32_t> points;
    for (std::uint32_t p = 0; p < set.size(); p += 5) points.push_back(p);
    LocalAnalysis analysis(places_of(set), set.values, 1, points, std::vector<double>(points.size(), 0.0),
                           {.covariance = each.covariance, .error_ratio = 0.4, .coverage = 0.2});
    for (std::uint32_t p = 0; p < set.size(); ++p) analysis.change_state(p);
    for (std::uint32_t p = 0; p < set.size(); ++p) {
      ASSERT_GT(analysis.variance(p), 0) << each.count;
      ASSERT_LT(analysis.variance(p), 0.16) << each.count;
    }
  }
}

}  // namespace
}  // namespace thin
