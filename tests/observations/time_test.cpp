#include "libthin/observations/time.h"

#include <gtest/gtest.h>

#include <ctime>
#include <random>

namespace thin {
namespace {

TEST(Time, AgreesWithTheSystemsCalendar) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const std::int64_t time_s = static_cast<std::int64_t>(random() % 8'000'000'000) - 2'000'000'000;  // 1906 .. 2160
    const std::time_t clock = time_s;
    std::tm expected{};
    ASSERT_NE(gmtime_r(&clock, &expected), nullptr);
    const CivilTime civil = to_civil(time_s * 1000 + 250);
    EXPECT_EQ(civil.year, expected.tm_year + 1900);
    EXPECT_EQ(civil.month, expected.tm_mon + 1);
    EXPECT_EQ(civil.day, expected.tm_mday);
    EXPECT_EQ(civil.hour, expected.tm_hour);
    EXPECT_EQ(civil.minute, expected.tm_min);
    EXPECT_DOUBLE_EQ(civil.second, expected.tm_sec + 0.25);
    EXPECT_EQ(to_time_ms(civil), time_s * 1000 + 250);
  }
}

TEST(Time, SecondSixtyCountsOn) {
  EXPECT_EQ(to_time_ms({2020, 10, 26, 23, 59, 60}), to_time_ms({2020, 10, 27, 0, 0, 0}));
}

TEST(Time, RefusesWhatIsNoTime) {
  EXPECT_FALSE(to_time_ms({2020, 13, 1, 0, 0, 0}));
  EXPECT_FALSE(to_time_ms({2020, 0, 1, 0, 0, 0}));
  EXPECT_FALSE(to_time_ms({2021, 2, 29, 0, 0, 0}));
  EXPECT_TRUE(to_time_ms({2020, 2, 29, 0, 0, 0}));
  EXPECT_FALSE(to_time_ms({2020, 1, 1, 24, 0, 0}));
  EXPECT_FALSE(to_time_ms({2020, 1, 1, 0, 60, 0}));
  EXPECT_FALSE(to_time_ms({2020, 1, 1, 0, 0, 61}));
  EXPECT_FALSE(to_time_ms({2020, 1, 1, 0, 0, -1}));
}

TEST(Time, WritesAndReadsIso8601) {
  EXPECT_EQ(to_iso8601(1'090'449'000'000), "2004-07-21T22:30:00Z");
  EXPECT_EQ(to_iso8601(1'090'449'000'007), "2004-07-21T22:30:00.007Z");
  EXPECT_EQ(to_compact_iso8601(1'090'449'000'999), "20040721T223000Z");
  EXPECT_EQ(to_iso8601(-1), "1969-12-31T23:59:59.999Z");
  EXPECT_EQ(from_iso8601("2004-07-21T22:30:00.007Z"), 1'090'449'000'007);
  EXPECT_EQ(from_iso8601("2004-07-21T22:30Z"), 1'090'449'000'000);
  EXPECT_EQ(from_iso8601("2004-07-21"), 1'090'368'000'000);
  for (const char* wrong : {"", "yesterday", "2004-07-21T", "2004-07-21T22", "2004-07-21T22:30:00X", "2004-02-30"})
    EXPECT_FALSE(from_iso8601(wrong)) << wrong;
}

TEST(Time, ReadsDurations) {
  EXPECT_EQ(duration_ms_from_iso8601("PT1H"), 3'600'000);
  EXPECT_EQ(duration_ms_from_iso8601("PT01H"), 3'600'000);
  EXPECT_EQ(duration_ms_from_iso8601("P1DT12H"), 129'600'000);
  EXPECT_EQ(duration_ms_from_iso8601("PT1M30S"), 90'000);
  EXPECT_EQ(duration_ms_from_iso8601("PT0S"), 0);
  EXPECT_EQ(duration_ms_from_iso8601("P2D"), 172'800'000);
  for (const char* wrong : {"", "P", "PT", "1H", "PT1", "P1H", "PT1S1H", "-PT1H", "PT1H ", "PT1.5H", "PT9999999H"})
    EXPECT_FALSE(duration_ms_from_iso8601(wrong)) << wrong;
}

}  // namespace
}  // namespace thin
