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

ObservationSet of_two_instruments() {
  ObservationSet amsua = temperatures(), mhs = temperatures();
  amsua.instrument.assign(100, Instrument::amsua);
  mhs.instrument.assign(100, Instrument::mhs);
  amsua.append(mhs);
  return amsua;
}

TEST(Screening, JudgesTheChannelsOfEachInstrumentByItself) {
  ObservationSet set = of_two_instruments();
  for (std::size_t i = 1; i < 100; i += 2) set.values[i * 6 + 1] = kMissing;  // AMSU-A 2 on NOAA-16
  set.values[150 * 6 + 4] = 69;                                               // MHS 2
  const auto screening = screen(set, {});
  ASSERT_TRUE(screening) << screening.error().message;
  EXPECT_EQ(screening->channel_places, (std::vector<std::size_t>{0, 2, 3, 4, 5}));
  ASSERT_EQ(screening->dead.size(), 1U);
  EXPECT_EQ(screening->dead[0].instrument, Instrument::amsua);
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_EQ(screening->reasons[i], i == 150 ? ScreeningReason::outside_limits : ScreeningReason::none);
}

TEST(Screening, TakesChannelsByInstrument) {
  const ObservationSet set = of_two_instruments();
  ScreeningOptions options;
  options.channels_of[Instrument::mhs] = {3};
  EXPECT_EQ(screen(set, options)->channel_places, (std::vector<std::size_t>{0, 1, 2, 5}));
  options.instruments = {Instrument::mhs};
  const auto screening = screen(set, options);
  EXPECT_EQ(screening->channel_places, (std::vector<std::size_t>{5}));
  EXPECT_EQ(screening->reasons[0], ScreeningReason::instrument);
  options.channels_of.clear();
  options.channels = {2};
  EXPECT_EQ(screen(set, options)->channel_places, (std::vector<std::size_t>{4}));
  options.instruments.clear();
  EXPECT_NE(screen(set, options).error().message.find("the window holds several instruments"), std::string::npos);
  options.channels_of[Instrument::amsua] = {7};
  options.channels.clear();
  EXPECT_EQ(screen(set, options).error().message,
            "[preparation] channels names channel 7, but the instrument AMSU-A has 1, 2, 3");
}

TEST(Screening, LeavesOutAnInstrumentWithoutALiveChannel) {
  ObservationSet set = of_two_instruments();
  for (std::size_t i = 100; i < 200; ++i)
    for (std::size_t c = 3; c < 6; ++c) set.values[i * 6 + c] = kMissing;
  const auto screening = screen(set, {});
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->reasons[0], ScreeningReason::none);
  EXPECT_EQ(screening->reasons[150], ScreeningReason::no_live_channel);
}

TEST(Screening, SelectsBySatelliteLatitudeEdgeAndSurface) {
  ObservationSet set = of_two_instruments();
  for (std::size_t i = 0; i < set.size(); ++i) set.surface[i] = i % 3 ? Surface::sea : Surface::unknown;
  ScreeningOptions options;
  options.platforms = {206};
  options.minimum_latitude_deg = -5;
  options.maximum_latitude_deg = 5;
  options.skip_edge = 1;
  options.skip_edge_of[Instrument::mhs] = 5;
  options.surfaces = {Surface::sea};
  const auto screening = screen(set, options);
  ASSERT_TRUE(screening);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const int view = set.field_of_view[i];
    const bool edge = i < 100 ? view == 1 || view == 30 : view <= 5 || view > 85;
    const ScreeningReason expected = set.platform[i] != 206               ? ScreeningReason::platform
                                     : std::abs(set.latitude_deg[i]) > 5  ? ScreeningReason::latitude
                                     : edge                               ? ScreeningReason::scan_position
                                     : set.surface[i] == Surface::unknown ? ScreeningReason::unknown_surface
                                                                          : ScreeningReason::none;
    EXPECT_EQ(screening->reasons[i], expected) << i;
  }
}

TEST(Screening, HoldsVariablesToTheirRules) {
  ObservationSet set = temperatures();
  std::vector<double>& flags = set.variables["flags"];
  std::vector<double>& angle = set.variables["angle"];
  for (std::size_t i = 0; i < set.size(); ++i) {
    flags.push_back(i % 4 == 3 ? kMissing : static_cast<double>(i % 4));
    angle.push_back(i % 10 == 9 ? kMissing : static_cast<double>(i));
  }
  ScreeningOptions options;
  options.flags = {{"flags", 2U}, {"absent", {}}};
  options.variables = {{"angle", 0, 50}};
  const auto screening = screen(set, options);
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->absent, (std::vector<std::string>{"absent"}));
  const auto rule = [](int number) {
    return static_cast<ScreeningReason>(static_cast<int>(ScreeningReason::first_rule) + number);
  };
  for (std::size_t i = 0; i < set.size(); ++i)
    EXPECT_EQ(screening->reasons[i], i % 4 == 2              ? rule(0)
                                     : i > 50 || i % 10 == 9 ? rule(2)
                                                             : ScreeningReason::none)
        << i;
  EXPECT_EQ(name_of(rule(0), options), "flags has bits of 0x2");
  EXPECT_EQ(name_of(rule(1), options), "absent is not 0");
  EXPECT_EQ(name_of(rule(2), options), "angle missing or outside 0 to 50");
}

TEST(Screening, WhereNothingIsSelectedNothingIsAnError) {
  ScreeningOptions options;
  options.platforms = {4};
  const auto screening = screen(temperatures(), options);
  ASSERT_TRUE(screening);
  EXPECT_EQ(screening->channel_places.size(), 3U);
}

}  // namespace
}  // namespace thin
