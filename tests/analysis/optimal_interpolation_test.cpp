#include "libthin/analysis/optimal_interpolation.h"

#include <gtest/gtest.h>

#include <random>

#include "libthin/foundation/parallel.h"
#include "tests/support/interpolation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(OptimalInterpolation, IsTheDenseSolution) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const std::size_t channels = seed == 5 ? 13 : seed, n = 60 + 20 * seed;
    const ObservationSet set = test::random_observations(n, channels, seed);
    const std::vector<Vector3> targets = test::random_observations(40, 1, seed + 100).position_km;
    const double length_km = 80.0 * seed;
    // The least one is not the first, and the largest is done long before it.
    const std::vector<double> ratios = {1.5, seed % 2 ? 0.4 : 0.1, seed % 2 ? 4.0 : 50.0};
    const auto results =
        OptimalInterpolation(set.position_km, targets, length_km).estimates(set.values, channels, ratios);
    ASSERT_EQ(results.size(), ratios.size());
    for (std::size_t r = 0; r < ratios.size(); ++r) {
      const test::DenseInterpolation dense(set.position_km, targets, length_km, ratios[r]);
      ASSERT_TRUE(dense.is_positive_definite());
      for (std::size_t c = 0; c < channels; ++c) {
        std::vector<double> values;
        for (std::size_t i = 0; i < n; ++i) values.push_back(set.values_of(i)[c]);
        const std::vector<double> expected = dense.estimate(values);
        for (std::size_t q = 0; q < targets.size(); ++q)
          EXPECT_NEAR(results[r][q * channels + c], expected[q], seed % 2 ? 3e-6 : 1e-4)
              << "ratio " << ratios[r] << ", channel " << c;
      }
    }
  }
}

TEST(OptimalInterpolation, OneRatioIsOneOfSeveral) {
  const ObservationSet set = test::random_observations(80, 2, 7);
  const std::vector<double> ratios = {1, 2};
  const OptimalInterpolation interpolation(set.position_km, set.position_km, 200);
  const auto several = interpolation.estimates(set.values, 2, ratios);
  const auto one = interpolation.estimate(set.values, 2, 2);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], several[1][i], 1e-6);
}

TEST(OptimalInterpolation, NothingObservedIsTheBackground) {
  const std::vector<Vector3> targets = test::random_observations(5, 1, 1).position_km;
  EXPECT_EQ(OptimalInterpolation({}, targets, 100).estimate({}, 1, 1), std::vector<double>(5, 0));
  const ObservationSet far = test::random_observations(5, 1, 1, {40, 50, 0, 10});
  EXPECT_EQ(OptimalInterpolation(far.position_km, targets, 100).estimate(far.values, 1, 1), std::vector<double>(5, 0));
}

TEST(OptimalInterpolation, SameBitsForAnyNumberOfThreads) {
  const ObservationSet set = test::random_observations(1500, 3, 3);
  const auto estimate = [&](int threads) {
    const ThreadLimit limit(threads);
    return OptimalInterpolation(set.position_km, set.position_km, 150).estimate(set.values, 3, 1);
  };
  EXPECT_EQ(estimate(1), estimate(2));
}

TEST(BackgroundCorrelation, IsNearTheGaussianAndItsDefinition) {
  double most = 0;
  for (double d = 0; d <= 500; d += 0.5) {
    EXPECT_NEAR(background_correlation(d, 100), test::gaspari_cohn(d, 100), 1e-12);
    most = std::max(most, std::abs(background_correlation(d, 100) - std::exp(-d * d / 20000)));
  }
  EXPECT_LT(most, 0.04);
  EXPECT_EQ(background_correlation(366, 100), 0);
  // The curvature at 0 is the Gaussian's.
  EXPECT_NEAR((1 - background_correlation(1, 100)) * 2 * 100 * 100, 1, 0.01);
}

// What it is there for: a Gaussian cut at three lengths fails here.
TEST(BackgroundCorrelation, IsPositiveDefiniteWithDenseObservations) {
  const ObservationSet dense = test::random_observations(400, 1, 11, {-1, 1, 179, 181});
  EXPECT_TRUE(test::DenseInterpolation(dense.position_km, {}, 60, 1e-4).is_positive_definite());
}

}  // namespace
}  // namespace thin
