#include "libthin/observations/observation_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "libthin/observations/platforms.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(ObservationSet, SelectKeepsEveryField) {
  const ObservationSet set = test::random_observations(50, 3, 1);
  const std::vector<std::uint32_t> indices = {7, 3, 49, 7};
  const ObservationSet selected = set.select(indices);
  ASSERT_EQ(selected.size(), 4U);
  EXPECT_EQ(selected.channels, set.channels);
  EXPECT_EQ(selected.value_kind, set.value_kind);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t from = indices[i];
    EXPECT_EQ(selected.latitude_deg[i], set.latitude_deg[from]);
    EXPECT_EQ(selected.longitude_deg[i], set.longitude_deg[from]);
    EXPECT_EQ(selected.position_km[i], set.position_km[from]);
    EXPECT_EQ(selected.time_ms[i], set.time_ms[from]);
    EXPECT_EQ(selected.platform[i], set.platform[from]);
    EXPECT_EQ(selected.scan_line[i], set.scan_line[from]);
    EXPECT_EQ(selected.field_of_view[i], set.field_of_view[from]);
    EXPECT_EQ(selected.surface[i], set.surface[from]);
    EXPECT_EQ(selected.source[i], set.source[from]);
    EXPECT_TRUE(std::ranges::equal(selected.values_of(i), set.values_of(from)));
  }
}

TEST(ObservationSet, AppendIsTheOneBehindTheOther) {
  const ObservationSet a = test::random_observations(5, 2, 2), b = test::random_observations(7, 2, 3);
  ObservationSet both = a;
  both.append(b);
  ASSERT_EQ(both.size(), 12U);
  EXPECT_EQ(both.time_ms[6], b.time_ms[1]);
  EXPECT_TRUE(std::ranges::equal(both.values_of(11), b.values_of(6)));
}

TEST(ObservationSet, AppendOfAnotherInstrumentAddsItsChannels) {
  ObservationSet amsua = test::random_observations(3, 2, 2), mhs = test::random_observations(2, 1, 3);
  amsua.instrument.assign(3, Instrument::amsua);
  mhs.instrument.assign(2, Instrument::mhs);
  mhs.first_guess_k = {250, 251};
  mhs.variables["zenith"] = {10, 20};
  ObservationSet one = amsua, other = mhs;
  one.append(mhs);
  other.append(amsua);
  EXPECT_EQ(one.channels, (std::vector<int>{1, 2, 1}));
  EXPECT_EQ(one.channel_instrument, (std::vector<Instrument>{Instrument::amsua, Instrument::amsua, Instrument::mhs}));
  EXPECT_EQ(other.channel_instrument, one.channel_instrument);
  EXPECT_TRUE(one.measures(2, 1));
  EXPECT_FALSE(one.measures(2, 2));
  EXPECT_EQ(one.values_of(2)[1], amsua.values_of(2)[1]);
  EXPECT_TRUE(std::isnan(one.values_of(2)[2]));
  EXPECT_TRUE(std::isnan(one.values_of(4)[0]));
  EXPECT_EQ(one.values_of(4)[2], mhs.values_of(1)[0]);
  EXPECT_EQ(other.values_of(1)[2], mhs.values_of(1)[0]);
  ASSERT_EQ(one.first_guess_k.size(), one.values.size());
  EXPECT_EQ(one.first_guess_k[14], 251);
  EXPECT_TRUE(std::isnan(one.first_guess_k[0]));
  EXPECT_TRUE(std::isnan(one.variables["zenith"][2]));
  EXPECT_EQ(one.variables["zenith"][4], 20);
  EXPECT_EQ(one.select_channels(std::vector<std::size_t>{2}).channel_instrument,
            std::vector<Instrument>{Instrument::mhs});
  EXPECT_EQ(one.select(std::vector<std::uint32_t>{4}).variables["zenith"], std::vector<double>{20});
}

TEST(ObservationSet, SelectChannelsKeepsTheirNumbers) {
  const ObservationSet set = test::random_observations(5, 4, 4);
  const std::vector<std::size_t> places = {1, 3};
  const ObservationSet selected = set.select_channels(places);
  EXPECT_EQ(selected.channels, (std::vector<int>{2, 4}));
  EXPECT_EQ(selected.values_of(2)[1], set.values_of(2)[3]);
}

TEST(CanonicalOrder, DoesNotDependOnTheOrderOfArrival) {
  ObservationSet set = test::random_observations(300, 2, 5);
  for (std::size_t i = 0; i < set.size(); ++i) set.time_ms[i] = static_cast<std::int64_t>(i % 5);  // many ties
  set.values[10] = set.values[20] = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::uint32_t> shuffle(set.size());
  for (std::uint32_t i = 0; i < shuffle.size(); ++i) shuffle[i] = i;
  const ObservationSet expected = set.select(canonical_order(set));
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    std::shuffle(shuffle.begin(), shuffle.end(), random);
    const ObservationSet shuffled = set.select(shuffle);
    EXPECT_EQ(shuffled.select(canonical_order(shuffled)).source, expected.source);
  }
}

TEST(CanonicalOrder, GoesByTimeThenSatelliteThenScanPosition) {
  ObservationSet set = test::random_observations(0, 1, 6);
  const std::vector<double> value = {0.0};
  set.push_back({.time_ms = 2, .platform = 1, .scan_line = 1, .field_of_view = 1, .source = {}}, value);
  set.push_back({.time_ms = 1, .platform = 2, .scan_line = 1, .field_of_view = 1, .source = {}}, value);
  set.push_back({.time_ms = 1, .platform = 1, .scan_line = 2, .field_of_view = 1, .source = {}}, value);
  set.push_back({.time_ms = 1, .platform = 1, .scan_line = 1, .field_of_view = 2, .source = {}}, value);
  set.push_back({.time_ms = 1, .platform = 1, .scan_line = 1, .field_of_view = 1, .source = {}}, value);
  EXPECT_EQ(canonical_order(set), (std::vector<std::uint32_t>{4, 3, 2, 1, 0}));
}

TEST(Platforms, HaveNamesAndNumbers) {
  EXPECT_EQ(platform_name(4), "Metop-A");
  EXPECT_EQ(platform_name(999), "satellite 999");
  EXPECT_EQ(platform_number("noaa-19"), 223);
  EXPECT_FALSE(platform_number("NOAA"));
}

}  // namespace
}  // namespace thin
