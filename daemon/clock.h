#pragma once

#include <chrono>
#include <cstdint>

namespace thind {

using MonotonicTime = std::chrono::steady_clock::time_point;

inline std::int64_t wall_clock_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

inline std::int64_t milliseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1000);
}

}  // namespace thind
