#include "libthin/analysis/withholding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "libthin/analysis/count_fitting.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

std::vector<Variant> variants(const std::vector<std::string>& methods) {
  std::vector<Variant> list;
  for (const std::string& method : methods) {
    Variant& variant = list.emplace_back();
    variant.label = method;
    variant.thinner = std::make_unique<Thinner>(*find_thinning_method(method));
    variant.thinner->declare_options(variant.options);
    if (variant.thinner->stops_at_count())
      variant.thinner->set_retain_count(1);
    else
      variant.fit = density_option(variant.options).value_or("");
  }
  return list;
}

WithholdingOptions options() {
  WithholdingOptions options;
  options.share = 0.25;
  options.draws = 2;
  options.lengths_km = {150, 400};
  options.error_ratios = {0.3, 1};
  return options;
}

Withholding withheld(const ObservationSet& set, const std::vector<std::string>& methods,
                     const WithholdingOptions& with = options()) {
  const std::vector<Variant> list = variants(methods);
  const auto result = withhold(set, list, {40, 150}, with, [](const std::string&) {});
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
  return result ? *result : Withholding{};
}

const WithheldScore& score_of(const Withholding& result, const std::string& label, std::optional<int> by = 0,
                              std::optional<int> predicted = 0) {
  for (const WithheldScore& score : result.scores)
    if (result.sets[score.set].label == label && score.thinned_by == by && score.predicted == predicted) return score;
  throw std::runtime_error("no score of " + label);
}

// Everything but what depends on the values of the withheld.
std::vector<double> what_methods_did(const Withholding& result) {
  std::vector<double> numbers;
  for (const WithheldSet& set : result.sets) numbers.insert(numbers.end(), set.retained.begin(), set.retained.end());
  for (const WithheldScore& score : result.scores)
    numbers.insert(numbers.end(), score.retained_rms.begin(), score.retained_rms.end());
  return numbers;
}

std::vector<double> all_numbers(const Withholding& result) {
  std::vector<double> numbers = what_methods_did(result);
  for (const WithheldScore& score : result.scores)
    for (const auto* list : {&score.relative_rms, &score.share_of_all, &score.length_km, &score.error_ratio})
      numbers.insert(numbers.end(), list->begin(), list->end());
  return numbers;
}

TEST(Withholding, EveryObservationIsWithheldOnceInFourDraws) {
  std::set<std::uint32_t> seen;
  for (int draw = 0; draw < 4; ++draw) {
    const auto withheld = withheld_in_draw(103, 0.25, draw, 1);
    EXPECT_EQ(withheld.size(), 25U);
    EXPECT_TRUE(std::is_sorted(withheld.begin(), withheld.end()));
    for (const std::uint32_t i : withheld) EXPECT_TRUE(seen.insert(i).second) << i;
  }
  EXPECT_EQ(seen.size(), 100U);
  EXPECT_NE(withheld_in_draw(103, 0.25, 0, 1), withheld_in_draw(103, 0.25, 4, 1));  // another order
  EXPECT_NE(withheld_in_draw(103, 0.25, 0, 1), withheld_in_draw(103, 0.25, 0, 2));
}

// What methods do must not change with what they must not see.
TEST(Withholding, NoMethodSeesTheWithheld) {
  const std::vector<std::string> methods = {"eea", "top_down_eea", "top_down_clustering", "box", "octree"};
  WithholdingOptions one = options();
  one.draws = 1;
  const ObservationSet set = test::random_observations(800, 2, 4);
  ObservationSet other = set;
  for (const std::uint32_t i : withheld_in_draw(set.size(), one.share, 0, one.seed))
    for (std::size_t c = 0; c < 2; ++c) other.values[i * 2 + c] = 50 - 30 * other.values[i * 2 + c];
  const Withholding first = withheld(set, methods, one), second = withheld(other, methods, one);
  EXPECT_EQ(what_methods_did(first), what_methods_did(second));
  EXPECT_NE(score_of(first, "eea").relative_rms, score_of(second, "eea").relative_rms);
  // And it does change with what they see.
  other = set;
  for (double& value : other.values) value = value * value;
  EXPECT_NE(what_methods_did(first), what_methods_did(withheld(other, methods, one)));
}

TEST(Withholding, SameForAnyOrderAndNumberOfThreads) {
  const ObservationSet set = test::random_observations(600, 2, 5);
  std::vector<std::uint32_t> order(set.size());
  for (std::uint32_t i = 0; i < set.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  const ObservationSet shuffled = set.select(order);
  const ObservationSet again = shuffled.select(canonical_order(shuffled));
  const std::vector<std::string> methods = {"eea", "poisson_disk"};
  const auto run = [&](const ObservationSet& observations, int threads) {
    const ThreadLimit limit(threads);
    return all_numbers(withheld(observations.select(canonical_order(observations)), methods));
  };
  EXPECT_EQ(run(set, 1), run(again, 2));
}

TEST(Withholding, TellsSignalFromNoise) {
  const ObservationSet signal = test::random_observations(900, 1, 6);  // noise of 0.2, a signal of 0.5
  const Withholding with_signal = withheld(signal, {"eea"});
  for (const double explained : score_of(with_signal, "all").explained) EXPECT_GT(explained, 0.6);
  for (const double share : score_of(with_signal, "all").share_of_all) EXPECT_DOUBLE_EQ(share, 1);
  for (const double rms : score_of(with_signal, "all").retained_rms) EXPECT_DOUBLE_EQ(rms, 1);

  ObservationSet noise = signal;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  for (double& value : noise.values) value = normal(random);
  for (const double explained : score_of(withheld(noise, {"eea"}), "all").explained) EXPECT_LT(explained, 0.06);
}

TEST(Withholding, JointSetsPredictEachChannel) {
  const ObservationSet set = test::random_observations(600, 3, 8);
  const Withholding result = withheld(set, {"eea"});
  double mean = 0;
  for (int c = 0; c < 3; ++c) mean += score_of(result, "eea", std::nullopt, c).explained[0] / 3;
  EXPECT_NEAR(score_of(result, "eea", std::nullopt, std::nullopt).explained[0], mean, 1e-12);
  // A set that ignores the values predicts alike, whatever it was thinned by.
  EXPECT_EQ(score_of(result, "farthest_point", 1, 1).explained,
            score_of(result, "farthest_point", std::nullopt, 1).explained);
}

TEST(Withholding, SaysWhatIsWrongWithTheValues) {
  ObservationSet set = test::random_observations(400, 1, 9);
  for (double& value : set.values) value += 3;
  set.values[17] = 60;
  const Withholding result = withheld(set, {"box"});
  ASSERT_EQ(result.notes.size(), 2U);
  EXPECT_NE(result.notes[0].find("kurtosis"), std::string::npos);
  EXPECT_NE(result.notes[1].find("bias"), std::string::npos);
  EXPECT_NEAR(result.channels[0].mean_k, 3.1, 0.2);
}

TEST(Withholding, AMethodThatFailsLeavesTheOthers) {
  ObservationSet set = test::random_observations(300, 1, 10);
  std::fill(set.scan_line.begin(), set.scan_line.end(), kUnknownNumber);
  const Withholding result = withheld(set, {"stepwise", "box"});
  ASSERT_EQ(result.failures.size(), 1U);
  for (const WithheldScore& score : result.scores) EXPECT_NE(result.sets[score.set].label, "stepwise");
  EXPECT_EQ(score_of(result, "box").explained.size(), 2U);
}

TEST(Withholding, MissingValuesAndTooFewAreErrors) {
  ObservationSet set = test::random_observations(300, 1, 10);
  set.values[3] = std::nan("");
  const std::vector<Variant> list = variants({"box"});
  const auto progress = [](const std::string&) {};
  EXPECT_FALSE(withhold(set, list, {10}, options(), progress));
  EXPECT_FALSE(withhold(test::random_observations(20, 1, 1), list, {10}, options(), progress));
}

}  // namespace
}  // namespace thin
