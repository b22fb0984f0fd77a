// What every method must do, whichever it is.

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "libthin/foundation/parallel.h"
#include "libthin/thinning/thinning_method.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

Retained thinned(const std::string& name, const ObservationSet& set, double fraction = 0.2) {
  return test::retained(test::thinner(name, {{"retain_fraction", fraction}}), set);
}

class MethodTest : public testing::TestWithParam<std::string> {};

TEST_P(MethodTest, RetainsSomeOfManyAscendingWithoutRepetition) {
  const ObservationSet set = test::random_observations(900, 3, 1);
  const Retained retained = thinned(GetParam(), set);
  EXPECT_GT(retained.size(), 20U);
  EXPECT_LT(retained.size(), 700U);
  for (std::size_t i = 1; i < retained.size(); ++i) EXPECT_LT(retained[i - 1], retained[i]);
  EXPECT_LT(retained.back(), set.size());
}

TEST_P(MethodTest, TakesFewPoleDateLineAndEqualOnes) {
  EXPECT_TRUE(thinned(GetParam(), test::random_observations(0, 2, 2)).empty());
  EXPECT_LE(thinned(GetParam(), test::random_observations(1, 2, 3)).size(), 1U);
  EXPECT_LE(thinned(GetParam(), test::random_observations(2, 1, 4)).size(), 2U);
  EXPECT_GT(thinned(GetParam(), test::random_observations(400, 1, 5, {88, 90, 0, 360})).size(), 0U);
  EXPECT_GT(thinned(GetParam(), test::random_observations(400, 1, 6, {-90, -88, -180, 180})).size(), 0U);
  ObservationSet equal = test::random_observations(300, 2, 7, {10, 10, 20, 20});
  EXPECT_GT(thinned(GetParam(), equal).size(), 0U);
  std::fill(equal.values.begin(), equal.values.end(), 1.0);
  EXPECT_GT(thinned(GetParam(), equal).size(), 0U);
}

TEST_P(MethodTest, IsTheSameForAnyNumberOfThreads) {
  const ObservationSet set = test::random_observations(3000, 5, 8);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return thinned(GetParam(), set);
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

TEST_P(MethodTest, IsTheSameForShuffledInput) {
  const ObservationSet set = test::random_observations(1500, 3, 9);
  std::vector<std::uint32_t> shuffle(set.size());
  std::iota(shuffle.begin(), shuffle.end(), 0U);
  std::mt19937 random(10);
  std::shuffle(shuffle.begin(), shuffle.end(), random);
  const ObservationSet shuffled = set.select(shuffle);
  const ObservationSet ordered = set.select(canonical_order(set));
  const ObservationSet reordered = shuffled.select(canonical_order(shuffled));
  EXPECT_EQ(ordered.values, reordered.values);
  EXPECT_EQ(thinned(GetParam(), ordered), thinned(GetParam(), reordered));
}

INSTANTIATE_TEST_SUITE_P(Registry, MethodTest, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const MethodEntry& entry : thinning_methods()) names.push_back(entry.name);
                           return names;
                         }()),
                         [](const auto& each) { return each.param; });

TEST(GridEea, IsDenseWhereTheSignalVaries) {
  // A step of 2 K along a meridian in the middle of a flat field: more than its share stays near the step.
  ObservationSet set = test::random_observations(4000, 1, 13, {-10, 10, 0, 40});
  std::size_t near_step = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.values[i] = set.longitude_deg[i] < 20 ? -1 : 1;
    near_step += std::abs(set.longitude_deg[i] - 20) < 3;
  }
  const Retained retained = thinned("grid_eea", set, 0.05);
  std::size_t retained_near_step = 0;
  for (const std::uint32_t i : retained) retained_near_step += std::abs(set.longitude_deg[i] - 20) < 3;
  EXPECT_GT(static_cast<double>(retained_near_step) / static_cast<double>(retained.size()),
            2 * static_cast<double>(near_step) / static_cast<double>(set.size()));
}

TEST(Stepwise, NeedsScanPositions) {
  ObservationSet set = test::random_observations(10, 1, 14);
  set.scan_line[4] = kUnknownNumber;
  const Result<Choice> retained = test::thinner("stepwise", {}).thin(set);
  ASSERT_FALSE(retained);
  EXPECT_NE(retained.error().message.find("observation 4 has no scan line number"), std::string::npos);
}

}  // namespace
}  // namespace thin
