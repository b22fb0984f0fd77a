#include "libthin/preparation/screening.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// 100 observations of two satellites (206 even, 207 odd), three channels at 250 K.
ObservationSet temperatures() {
  ObservationSet set = test::random_observations(100, 3, 1);
  set.value_kind = ValueKind::brightness_temperature;
  std::fill(set.values.begin(), set.values.end(), 250.0);
  return set;
}

TEST(Screening, KeepsWhatIsWhole) {
  const auto screening = screen(temperatures(), {});
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->channel_places, (std::vector<std::size_t>{0, 1, 2}));
  for (const ScreeningReason reason : screening->reasons) EXPECT_EQ(reason, ScreeningReason::none);
  EXPECT_TRUE(screening->dead.empty());
}

TEST(Screening, LeavesOutAChannelThatIsDeadOnOneSatellite) {
  ObservationSet set = temperatures();
  for (std::size_t i = 1; i < set.size(); i += 2) set.values[i * 3 + 1] = kMissing;
  const auto screening = screen(set, {});
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->channel_places, (std::vector<std::size_t>{0, 2}));
  ASSERT_EQ(screening->dead.size(), 1U);
  EXPECT_EQ(screening->dead[0].channel, 2);
  EXPECT_EQ(screening->dead[0].platform, 207);
  EXPECT_EQ(screening->dead[0].missing, 50U);
  for (const ScreeningReason reason : screening->reasons) EXPECT_EQ(reason, ScreeningReason::none);
}

TEST(Screening, ScreensTheSatelliteInsteadWhenTheChannelIsAskedFor) {
  ObservationSet set = temperatures();
  for (std::size_t i = 1; i < set.size(); i += 2) set.values[i * 3 + 1] = kMissing;
  ScreeningOptions options;
  options.channels = {2};
  const auto screening = screen(set, options);
  ASSERT_TRUE(screening);
  for (std::size_t i = 0; i < set.size(); ++i)
    EXPECT_EQ(screening->reasons[i], i % 2 ? ScreeningReason::missing_value : ScreeningReason::none);
}

TEST(Screening, ScreensSingleGapsAndGrossErrors) {
  ObservationSet set = temperatures();
  set.values[3 * 10] = kMissing;
  set.values[3 * 20 + 2] = 0.0;
  set.values[3 * 21 + 2] = 401;
  const auto screening = screen(set, {});
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->channel_places.size(), 3U);
  EXPECT_EQ(screening->reasons[10], ScreeningReason::missing_value);
  EXPECT_EQ(screening->reasons[20], ScreeningReason::outside_limits);
  EXPECT_EQ(screening->reasons[21], ScreeningReason::outside_limits);
  EXPECT_EQ(screening->reasons[22], ScreeningReason::none);
}

TEST(Screening, GrossLimitsAreNotForInnovations) {
  ObservationSet set = temperatures();
  set.value_kind = ValueKind::innovation;
  std::fill(set.values.begin(), set.values.end(), -0.5);
  const auto screening = screen(set, {});
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->reasons[0], ScreeningReason::none);
}

TEST(Screening, NamesWhatIsDeadWhenNothingIsLeft) {
  ObservationSet set = temperatures();
  std::fill(set.values.begin(), set.values.end(), kMissing);
  const auto screening = screen(set, {});
  ASSERT_FALSE(screening);
  EXPECT_EQ(screening.error().kind, ErrorKind::input);
  EXPECT_NE(screening.error().message.find("1 on NOAA-15, 1 on NOAA-16, 2 on NOAA-15"), std::string::npos)
      << screening.error().message;
}

TEST(Screening, RefusesAChannelThatTheInstrumentHasNot) {
  ScreeningOptions options;
  options.channels = {2, 16};
  const auto screening = screen(temperatures(), options);
  ASSERT_FALSE(screening);
  EXPECT_EQ(screening.error().kind, ErrorKind::configuration);
  EXPECT_NE(screening.error().message.find("channel 16"), std::string::npos);
}

TEST(Screening, OfNothingIsNothing) {
  const auto screening = screen(test::random_observations(0, 3, 1), {});
  ASSERT_TRUE(screening);
  EXPECT_TRUE(screening->reasons.empty());
}

}  // namespace
}  // namespace thin
