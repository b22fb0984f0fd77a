#include "libthin/analysis/evaluation.h"

#include <gtest/gtest.h>

#include "libthin/analysis/count_fitting.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

Variant variant(const std::string& method, const std::string& label = "") {
  Variant variant;
  variant.label = label.empty() ? method : label;
  variant.thinner = std::make_unique<Thinner>(*find_thinning_method(method));
  variant.thinner->declare_options(variant.options);
  if (!variant.thinner->stops_at_count()) variant.fit = density_option(variant.options).value_or("");
  return variant;
}

Result<Evaluation> evaluated(const ObservationSet& set, const std::vector<Variant>& variants,
                             const EvaluationOptions& options) {
  return evaluate(set, variants, options, [](const std::string&) {});
}

TEST(Evaluation, HasAPointForEachVariantAndNumber) {
  const ObservationSet set = test::random_observations(600, 2, 1);
  std::vector<Variant> variants;
  for (const char* method : {"eea", "box", "stepwise"}) variants.push_back(variant(method));
  const EvaluationOptions options{.methods = {}, .counts = {200, 50, 200}, .level = 4, .repetitions = 2};
  const auto evaluation = evaluated(set, variants, options);
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_EQ(evaluation->results.size(), 6U);
  ASSERT_EQ(evaluation->costs.size(), 6U);
  EXPECT_TRUE(evaluation->failures.empty());
  for (std::size_t i = 0; i < 6; ++i) {
    const Evaluated& result = evaluation->results[i];
    EXPECT_EQ(result.variant, i / 2);
    EXPECT_EQ(result.asked, i % 2 ? 200 : 50);
    EXPECT_EQ(result.fitted_value.has_value(), i >= 2);
    EXPECT_EQ(evaluation->costs[i].seconds.size(), 2U);
    EXPECT_GT(result.signal_to_noise_grid_db, 0);
    EXPECT_EQ(result.boxes.empty(), result.variant == 2);  // not against itself
  }
  EXPECT_EQ(evaluation->results[0].retained.size(), 50U);
  EXPECT_EQ(evaluation->results[1].retained.size(), 200U);
  EXPECT_GT(evaluation->results[0].error.on_grid.mean_squared_k2, evaluation->results[1].error.on_grid.mean_squared_k2);
}

TEST(Evaluation, AVariantThatTheObservationsDoNotFitLeavesTheOthers) {
  ObservationSet set = test::random_observations(100, 1, 1);
  std::fill(set.scan_line.begin(), set.scan_line.end(), kUnknownNumber);
  std::vector<Variant> variants;
  variants.push_back(variant("stepwise"));
  variants.push_back(variant("box"));
  const auto evaluation = evaluated(set, variants, {.methods = {}, .counts = {10}, .level = 3});
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->failures.size(), 1U);
  EXPECT_EQ(evaluation->failures[0].variant, 0U);
  EXPECT_NE(evaluation->failures[0].reason.find("scan line"), std::string::npos);
  ASSERT_EQ(evaluation->results.size(), 1U);
  EXPECT_EQ(evaluation->results[0].variant, 1U);
  EXPECT_TRUE(evaluation->results[0].boxes.empty());  // nothing to compare with
}

TEST(Evaluation, AVariantWithoutFitRunsOnceAsItIs) {
  const ObservationSet set = test::random_observations(300, 1, 2);
  std::vector<Variant> variants;
  variants.push_back(variant("box"));
  variants[0].fit.clear();
  const auto evaluation = evaluated(set, variants, {.methods = {}, .counts = {10, 20}, .errors = false});
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->results.size(), 1U);
  EXPECT_FALSE(evaluation->results[0].asked);
}

}  // namespace
}  // namespace thin
