#include "libthin/analysis/twin_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libthin/foundation/parallel.h"
#include "tests/support/interpolation_oracle.h"

namespace thin {
namespace {

std::vector<Variant> one_variant(const std::string& method) {
  std::vector<Variant> variants(1);
  variants[0].label = method;
  variants[0].thinner = std::make_unique<Thinner>(*find_thinning_method(method));
  variants[0].thinner->declare_options(variants[0].options);
  return variants;
}

TwinOptions small() {
  TwinOptions options;
  options.observations.satellites = {"NOAA-16"};
  options.observations.window_minutes = 12;
  options.observations.step = 2;
  options.counts = {60};
  options.cases = 2;
  return options;
}

const TwinScore& score_of(const Twin& twin, const std::string& label) {
  return *std::find_if(twin.scores.begin(), twin.scores.end(), [&](const auto& score) { return score.label == label; });
}

Twin run(const std::vector<Variant>& variants, const TwinOptions& options) {
  auto twin = twin_experiment(variants, options, [](const std::string&) {});
  EXPECT_TRUE(twin) << (twin ? "" : twin.error().message);
  return twin ? *twin : Twin{};
}

TEST(TwinExperiment, NothingRetainedLeavesTheBackground) {
  const TwinOptions options = small();
  const Twin twin = run({}, options);
  for (const double error : nominal_errors(twin.scores.front(), twin.scores.front(), options)) EXPECT_EQ(error, 1);
  for (const double error : tuned_errors(score_of(twin, "all"), twin.scores.front())) EXPECT_LT(error, 0.6);
}

// The error of an optimal analysis is known beforehand: the mean of C - C (C + R)^-1 C over the targets.
TEST(TwinExperiment, TheErrorIsWhatTheoryExpects) {
  TwinOptions options = small();
  options.flow_dependence = 0;
  options.observations.step = 3;
  options.cases = 24;
  options.error_factors = {1};
  const Twin twin = run({}, options);
  double expected = 0, measured = 0, background = 0;
  for (int number = 0; number < options.cases; ++number) {
    const auto made = twin_case(options, number);
    ASSERT_TRUE(made);
    const test::DenseInterpolation dense(made->innovations.position_km, made->targets, options.background_length_km,
                                         options.observations.observation_error_k);
    const std::vector<double> variances = dense.error_variances();
    expected += std::accumulate(variances.begin(), variances.end(), 0.0) / static_cast<double>(variances.size());
    measured += score_of(twin, "all").mean_squared_k2[0][static_cast<std::size_t>(number)];
    background += twin.scores.front().mean_squared_k2[0][static_cast<std::size_t>(number)];
  }
  EXPECT_NEAR(background / options.cases, 1, 0.2);
  EXPECT_NEAR(measured / expected, 1, 0.15) << "expected " << expected / options.cases;
}

TEST(TwinExperiment, TheRightObservationErrorIsBest) {
  TwinOptions options = small();
  options.flow_dependence = 0;
  options.cases = 6;
  options.error_factors = {0.1, 1, 10};
  const TwinScore all = score_of(run({}, options), "all");
  const auto sum = [&](std::size_t f) {
    return std::accumulate(all.mean_squared_k2[f].begin(), all.mean_squared_k2[f].end(), 0.0);
  };
  EXPECT_LT(sum(1), sum(0));
  EXPECT_LT(sum(1), sum(2));
  for (const std::size_t factor : tuned_factors(all)) EXPECT_EQ(factor, 1U);
}

TEST(TwinExperiment, ErrorsAreAsAskedFor) {
  TwinOptions options = small();
  options.observations.window_minutes = 60;
  options.observations.channels = 2;
  options.observations.correlated_error_k = 0.3;
  options.observations.outlier_share = 0.1;
  options.observations.outlier_size_k = 5;
  const auto made = twin_case(options, 1);
  ASSERT_TRUE(made);
  const std::size_t n = made->innovations.size();
  ASSERT_GT(n, 500U);
  const double outliers = std::accumulate(made->errors.is_outlier.begin(), made->errors.is_outlier.end(), 0.0);
  EXPECT_NEAR(outliers / static_cast<double>(n), 0.1, 0.05);
  double square = 0, count = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!made->errors.is_outlier[i]) square += std::pow(made->errors.errors_k[2 * i], 2), ++count;
  EXPECT_NEAR(std::sqrt(square / count), options.observations.total_error_k(), 0.05);
  for (std::size_t i = 0; i < n; ++i)
    if (made->errors.is_outlier[i]) {
      EXPECT_GT(std::abs(made->errors.errors_k[2 * i]), 2);
    }
  EXPECT_GT(made->targets.size(), 100U);
}

TEST(TwinExperiment, SameBitsForAnyNumberOfThreads) {
  const auto variants = one_variant("eea");
  const auto errors = [&](int threads) {
    const ThreadLimit limit(threads);
    return score_of(run(variants, small()), "eea").mean_squared_k2;
  };
  EXPECT_EQ(errors(1), errors(2));
}

}  // namespace
}  // namespace thin
