#include "libthin/analysis/uniform_subset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "libthin/observations/geodesy.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

// Each step tried with all pairs.
std::vector<std::uint32_t> farthest_by_brute_force(const std::vector<Vector3>& places, std::size_t count) {
  std::vector<std::uint32_t> retained = {0};
  while (retained.size() < count) {
    std::uint32_t best = 0;
    double farthest = -1;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      double nearest = 1e9;
      for (const std::uint32_t r : retained) nearest = std::min(nearest, chord_km(places[i], places[r]));
      if (nearest > farthest) farthest = nearest, best = i;
    }
    retained.push_back(best);
  }
  std::sort(retained.begin(), retained.end());
  return retained;
}

TEST(FarthestPointSubset, IsTheBruteForceOne) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto places = test::random_observations(150, 1, seed).position_km;
    for (const std::size_t count : {1U, 2U, 40U, 150U})
      EXPECT_EQ(farthest_point_subset(places, count), farthest_by_brute_force(places, count));
    EXPECT_EQ(farthest_point_subset(places, 1000).size(), 150U);
  }
  EXPECT_TRUE(farthest_point_subset({}, 3).empty());
}

TEST(FarthestPointSubset, TakesEqualPlacesToo) {
  const std::vector<Vector3> places(4, Vector3{6371, 0, 0});
  EXPECT_EQ(farthest_point_subset(places, 3), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(RandomSubset, IsASubsetOfTheSeed) {
  const auto subset = random_subset(100, 30, 5);
  EXPECT_EQ(std::set<std::uint32_t>(subset.begin(), subset.end()).size(), 30U);
  EXPECT_TRUE(std::is_sorted(subset.begin(), subset.end()));
  EXPECT_LT(subset.back(), 100U);
  EXPECT_EQ(subset, random_subset(100, 30, 5));
  EXPECT_NE(subset, random_subset(100, 30, 6));
}

TEST(RandomSubset, TakesAllAlike) {
  std::vector<int> taken(20, 0);
  for (std::uint64_t seed = 0; seed < 2000; ++seed)
    for (const std::uint32_t i : random_subset(20, 5, seed)) ++taken[i];
  for (const int times : taken) EXPECT_NEAR(times, 500, 100);  // five standard deviations
}

}  // namespace
}  // namespace thin
