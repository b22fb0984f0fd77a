#include "libthin/preparation/companion.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/preparation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

// The same places, shifted a little, with a first guess; some fields of view unknown.
ObservationSet shifted(const ObservationSet& set, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  ObservationSet moved;
  moved.channels = {2, 1, 3};
  std::sort(moved.channels.begin(), moved.channels.end());
  const double values[] = {0, 0, 0};
  for (std::size_t i = 0; i < set.size(); ++i)
    moved.push_back({.latitude_deg = set.latitude_deg[i] + 0.09 * unit(random),
                     .longitude_deg = set.longitude_deg[i] + 0.09 * unit(random),
                     .time_ms = set.time_ms[i] + static_cast<std::int64_t>(90'000 * unit(random)),
                     .platform = set.platform[i],
                     .field_of_view = unit(random) < 0.3 ? kUnknownNumber : set.field_of_view[i],
                     .source = {0, 0, static_cast<std::uint32_t>(i)}},
                    values);
  for (std::size_t i = 0; i < moved.values.size(); ++i) moved.first_guess_k.push_back(200 + static_cast<double>(i));
  return moved;
}

TEST(Companion, IsTheNearestOfEveryCandidate) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    ObservationSet set = test::random_observations(600, 2, seed, {0, 2, 179, 181});
    ObservationSet companions = shifted(set, seed);
    companions = companions.select(canonical_order(companions));
    take_companions(set, companions, {});
    std::size_t matched = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto expected = test::companion_by_brute_force(set, i, companions, 10, 1);
      for (std::size_t c = 0; c < 2; ++c) {
        const double guess_k = set.first_guess_k[2 * i + c];
        if (expected)
          EXPECT_EQ(guess_k, companions.first_guess_k[3 * *expected + c]) << i;
        else
          EXPECT_TRUE(std::isnan(guess_k)) << i;
      }
      matched += expected.has_value();
    }
    EXPECT_GT(matched, 100U);
    EXPECT_LT(matched, 600U);
  }
}

TEST(Companion, WithoutFirstGuessIsNone) {
  ObservationSet set = test::random_observations(10, 1, 1);
  take_companions(set, set, {});
  for (const double guess_k : set.first_guess_k) EXPECT_TRUE(std::isnan(guess_k));
}

}  // namespace
}  // namespace thin
