#include "daemon/windows.h"

#include <algorithm>
#include <cassert>

#include "libthin/observations/time.h"

namespace thind {
namespace {

// Towards minus infinity, for times before the anchor.
std::int64_t floor_divide(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t quotient = numerator / denominator;
  return quotient * denominator > numerator ? quotient - 1 : quotient;
}

}  // namespace

Interval window_at(const WindowGrid& grid, std::int64_t time_ms) {
  assert(grid.length_ms > 0);
  const std::int64_t begin_ms =
      floor_divide(time_ms - grid.anchor_ms, grid.length_ms) * grid.length_ms + grid.anchor_ms;
  return {begin_ms, begin_ms + grid.length_ms};
}

std::optional<std::vector<Interval>> windows_between(const WindowGrid& grid, std::int64_t first_ms,
                                                     std::int64_t last_ms, std::int64_t limit) {
  assert(first_ms <= last_ms);
  Interval window = window_at(grid, first_ms);
  if ((window_at(grid, last_ms).begin_ms - window.begin_ms) / grid.length_ms >= limit) return std::nullopt;
  std::vector<Interval> windows;
  for (; window.begin_ms <= last_ms; window = {window.end_ms, window.end_ms + grid.length_ms})
    windows.push_back(window);
  return windows;
}

std::string window_name(const Interval& interval, WindowKind kind, int version) {
  const std::string name =
      thin::to_compact_iso8601(interval.begin_ms) + "-" + thin::to_compact_iso8601(interval.end_ms);
  if (kind == WindowKind::late) return name + ".late" + std::to_string(version);
  return version > 1 ? name + ".v" + std::to_string(version) : name;
}

std::int64_t closing_time(const Interval& interval, const ClosingRule& rule, std::int64_t last_arrival_ms,
                          bool all_expected_there) {
  const std::int64_t quiet_from_ms = last_arrival_ms + rule.quiet_ms;
  return all_expected_there ? quiet_from_ms : std::max(interval.end_ms + rule.cutoff_ms, quiet_from_ms);
}

bool may_close(std::int64_t closing_ms, std::int64_t now_ms, std::optional<std::int64_t> oldest_undecided_ms) {
  return now_ms >= closing_ms && !(oldest_undecided_ms && *oldest_undecided_ms <= closing_ms);
}

}  // namespace thind
