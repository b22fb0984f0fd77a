#pragma once

// Assimilation windows as arithmetic: which windows a time belongs to, when a window may close, what its output is
// called. Times are UTC milliseconds (libthin/observations/time.h), ends are exclusive.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thind {

struct Interval {
  std::int64_t begin_ms = 0;
  std::int64_t end_ms = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

// Windows lie side by side: [anchor + k length, anchor + (k + 1) length) for every whole k.
// REQUIRES: length_ms > 0
struct WindowGrid {
  std::int64_t length_ms = std::int64_t{180} * 60'000;
  std::int64_t anchor_ms = 0;
};

Interval window_at(const WindowGrid& grid, std::int64_t time_ms);

// The windows that have a part in [first_ms, last_ms], in their order. Nothing where there are more than `limit`: such
// a span comes from wrong times, not from an orbit. REQUIRES: first_ms <= last_ms
std::optional<std::vector<Interval>> windows_between(const WindowGrid& grid, std::int64_t first_ms,
                                                     std::int64_t last_ms, std::int64_t limit);

// What an output is: the first of its window, a later version of it with the late data in it, or late data alone.
enum class WindowKind { window, late, file };

// "20260101T000000Z-20260101T030000Z", with ".v2" for the second version, ".late1" for the first late data.
std::string window_name(const Interval& interval, WindowKind kind, int version);

struct ClosingRule {
  std::int64_t cutoff_ms = 0;  // after the window's end, by the wall clock
  std::int64_t quiet_ms = 0;   // without a new file for the window
};

// When the window may close: it is complete early where all expected platforms are there.
std::int64_t closing_time(const Interval& interval, const ClosingRule& rule, std::int64_t last_arrival_ms,
                          bool all_expected_there);

// A window closes once its closing time has come, and every file that was noticed by then is decided: thinned without a
// file that lies in the inbox already, its output would depend on the speed of the machine. Files noticed later don't
// hold it up, so that a steady stream for other windows can't keep it open. `oldest_undecided_ms`: when the first of
// the files that are not yet decided was noticed.
bool may_close(std::int64_t closing_ms, std::int64_t now_ms, std::optional<std::int64_t> oldest_undecided_ms);

}  // namespace thind
