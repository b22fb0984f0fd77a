#include "libthin/preparation/preparation.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(Preparation, CountsEveryObservationOnce) {
  ObservationSet set = test::random_observations(1000, 2, 1);  // 200 ms apart
  for (std::size_t i = 0; i < set.size(); i += 50) set.values[i * 2] = std::numeric_limits<double>::quiet_NaN();
  const Result<Prepared> prepared = prepare(set, {20'000, 100'000}, {});
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->outside_window, 600U);
  std::size_t in_window = 0, screened = 0;
  for (const auto& [platform, tally] : prepared->platforms) {
    in_window += tally.observations;
    for (const auto& [reason, count] : tally.screened) screened += count;
  }
  EXPECT_EQ(in_window, 400U);
  EXPECT_EQ(screened, 8U);
  EXPECT_EQ(prepared->observations.size(), 392U);
  EXPECT_EQ(prepared->origin.size(), 392U);
  for (std::size_t i = 0; i < prepared->origin.size(); ++i)
    EXPECT_EQ(prepared->observations.source[i], set.source[prepared->origin[i]]);
}

TEST(Preparation, WindowIsHalfOpen) {
  const ObservationSet set = test::random_observations(10, 1, 2);
  const Result<Prepared> prepared = prepare(set, {200, 400}, {});
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->origin, (std::vector<std::uint32_t>{1}));
}

TEST(Preparation, IsTheSameForShuffledInput) {
  const ObservationSet set = test::random_observations(500, 3, 3);
  std::vector<std::uint32_t> backwards;
  for (std::uint32_t i = 500; i-- > 0;) backwards.push_back(i);
  const Result<Prepared> a = prepare(set, {}, {}), b = prepare(set.select(backwards), {}, {});
  EXPECT_EQ(a->observations.values, b->observations.values);
  EXPECT_EQ(a->observations.source, b->observations.source);
}

}  // namespace
}  // namespace thin
