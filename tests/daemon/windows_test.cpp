#include "daemon/windows.h"

#include <gtest/gtest.h>

#include <random>

#include "libthin/observations/time.h"

namespace thind {
namespace {

constexpr std::int64_t kMinute = 60'000;

std::int64_t at(const char* text) {
  return *thin::from_iso8601(text);
}

// Walks from the anchor, one window at a time.
Interval window_by_walking(const WindowGrid& grid, std::int64_t time_ms) {
  Interval window{grid.anchor_ms, grid.anchor_ms + grid.length_ms};
  while (time_ms >= window.end_ms) window = {window.end_ms, window.end_ms + grid.length_ms};
  while (time_ms < window.begin_ms) window = {window.begin_ms - grid.length_ms, window.begin_ms};
  return window;
}

TEST(Windows, CentreOnTheHoursWithAnAnchor) {
  const WindowGrid grid{180 * kMinute, -90 * kMinute};
  EXPECT_EQ(window_at(grid, at("2026-01-01T00:00:00Z")),
            (Interval{at("2025-12-31T22:30:00Z"), at("2026-01-01T01:30:00Z")}));
  EXPECT_EQ(window_at(grid, at("2026-01-01T01:30:00Z")),
            (Interval{at("2026-01-01T01:30:00Z"), at("2026-01-01T04:30:00Z")}));
}

TEST(Windows, EndsAreExclusiveBeforeTheEpochToo) {
  const WindowGrid grid{180 * kMinute, 0};
  EXPECT_EQ(window_at(grid, -1), (Interval{-180 * kMinute, 0}));
  EXPECT_EQ(window_at(grid, 0), (Interval{0, 180 * kMinute}));
  EXPECT_EQ(window_at(grid, -180 * kMinute), (Interval{-180 * kMinute, 0}));
  EXPECT_EQ(window_at(grid, -180 * kMinute - 1), (Interval{-360 * kMinute, -180 * kMinute}));
}

TEST(Windows, AgreeWithWalking) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 2000; ++trial) {
    const WindowGrid grid{std::uniform_int_distribution<std::int64_t>(1, 1000)(random),
                          std::uniform_int_distribution<std::int64_t>(-2000, 2000)(random)};
    const auto time_ms = std::uniform_int_distribution<std::int64_t>(-20000, 20000)(random);
    ASSERT_EQ(window_at(grid, time_ms), window_by_walking(grid, time_ms)) << grid.length_ms << " " << grid.anchor_ms;
  }
}

TEST(Windows, AFileBelongsToEachWindowThatItsTimesTouch) {
  const WindowGrid grid{100, 0};
  EXPECT_EQ(*windows_between(grid, -1, 0, 9), (std::vector<Interval>{{-100, 0}, {0, 100}}));
  EXPECT_EQ(*windows_between(grid, 0, 99, 9), (std::vector<Interval>{{0, 100}}));
  EXPECT_EQ(*windows_between(grid, 99, 200, 9), (std::vector<Interval>{{0, 100}, {100, 200}, {200, 300}}));
}

TEST(Windows, TooWideASpanIsRefusedAtTheLimit) {
  const WindowGrid grid{100, 0};
  EXPECT_TRUE(windows_between(grid, 0, 399, 4));
  EXPECT_FALSE(windows_between(grid, 0, 400, 4));
  EXPECT_FALSE(windows_between(grid, 0, std::int64_t{1} << 50, 4));
}

TEST(Windows, NamesSayIntervalAndVersion) {
  const Interval interval{at("2026-01-01T00:00:00Z"), at("2026-01-01T03:00:00Z")};
  EXPECT_EQ(window_name(interval, WindowKind::window, 1), "20260101T000000Z-20260101T030000Z");
  EXPECT_EQ(window_name(interval, WindowKind::window, 2), "20260101T000000Z-20260101T030000Z.v2");
  EXPECT_EQ(window_name(interval, WindowKind::late, 1), "20260101T000000Z-20260101T030000Z.late1");
}

TEST(Windows, CloseAfterCutOffAndQuiet) {
  const Interval interval{0, 1000};
  const ClosingRule rule{.cutoff_ms = 500, .quiet_ms = 50};
  EXPECT_EQ(closing_time(interval, rule, 700, false), 1500);
  EXPECT_EQ(closing_time(interval, rule, 1490, false), 1540);
  EXPECT_EQ(closing_time(interval, rule, 700, true), 750) << "all expected platforms are there";
}

TEST(Windows, WaitForWhatWasInTheInboxInTime) {
  EXPECT_FALSE(may_close(1000, 999, std::nullopt));
  EXPECT_TRUE(may_close(1000, 1000, std::nullopt));
  EXPECT_FALSE(may_close(1000, 5000, 1000)) << "noticed in time";
  EXPECT_TRUE(may_close(1000, 5000, 1001)) << "a steady stream must not keep it open";
}

}  // namespace
}  // namespace thind
