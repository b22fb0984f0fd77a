#include "libthin/formats/file_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/observations/time.h"
#include "tests/support/bufr_messages.h"

namespace thin {
namespace {

using test::ScratchFolder;
using test::TestSounding;

TEST(FileSummary, CountsMessagesSubsetsAndChannels) {
  const ScratchFolder folder;
  std::vector<TestSounding> soundings = test::test_soundings(35);  // two scan lines
  for (TestSounding& s : soundings) s.slots[6].second = test::kMissingValue;
  soundings[0].slots[0].second = 150;
  soundings[1].slots[0].second = 300;
  soundings[2].latitude_deg = test::kMissingValue;
  std::vector<TestSounding> other = test::test_soundings(2);
  for (TestSounding& s : other) s.sensor = 5;
  std::vector<TestSounding> second = test::test_soundings(1);
  second[0].platform = 223;
  second[0].slots[6].second = test::kMissingValue;
  const auto summary =
      summarise_file(folder.write("file", test::joined({test::make_message(soundings), test::make_message(other),
                                                        test::make_message(second, {.edition = 3})})));
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->editions, (std::vector<int>{3, 4}));
  EXPECT_EQ(summary->descriptors, std::vector<int>{310009});
  EXPECT_EQ(summary->messages, 3U);
  EXPECT_EQ(summary->messages_in_use, 2U);
  EXPECT_EQ(summary->subsets_in_use, 36U);
  EXPECT_EQ(summary->observations, 35U);
  EXPECT_EQ(summary->skipped.size(), 2U);
  ASSERT_EQ(summary->platforms.size(), 2U);
  EXPECT_EQ(summary->platforms[0].platform, 4);
  EXPECT_EQ(summary->platforms[0].observations, 34U);
  EXPECT_EQ(summary->scan_lines, 3U);
  ASSERT_EQ(summary->channels.size(), 15U);
  EXPECT_EQ(summary->channels[6].missing, 35U);
  EXPECT_TRUE(std::isnan(summary->channels[6].mean_k));
  EXPECT_NEAR(summary->channels[0].minimum_k, 150, 0.01);
  EXPECT_NEAR(summary->channels[0].maximum_k, 300, 0.01);
  EXPECT_EQ(to_iso8601(summary->last_time_ms), "2020-06-15T12:30:34.125Z");
}

TEST(FileSummary, TheAreaMayCrossTheDateLine) {
  ObservationSet set;
  set.channels = {1};
  const double value[] = {250};
  for (const double longitude : {170.0, -175.0, 178.0, 190.0})
    set.push_back({.latitude_deg = longitude / 10, .longitude_deg = longitude, .source = {}}, value);
  const Area area = summarise_observations(set).area;
  EXPECT_DOUBLE_EQ(area.west_deg, 170);
  EXPECT_DOUBLE_EQ(area.east_deg, -170);
  EXPECT_DOUBLE_EQ(area.south_deg, -17.5);
  EXPECT_DOUBLE_EQ(area.north_deg, 19);
}

TEST(FileSummary, ErrorsAreTheReaders) {
  const ScratchFolder folder;
  EXPECT_EQ(summarise_file(folder.write("empty", {})).error().kind, ErrorKind::incomplete);
  EXPECT_EQ(summarise_file(folder.write("text", test::bytes_of("hello"))).error().kind, ErrorKind::input);
  EXPECT_EQ(summarise_file(folder.path("absent")).error().kind, ErrorKind::input);
}

}  // namespace
}  // namespace thin
