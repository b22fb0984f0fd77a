#pragma once

// What systemd is told; without it, nothing happens.

#include <cstdint>
#include <optional>
#include <string>

namespace thind {

class Notification {
 public:
  Notification();

  void ready(const std::string& status) const;
  void reloading() const;
  void stopping() const;
  // The loop has come round: called by nothing else, so that a hanging daemon is noticed.
  void alive() const;

  // The longest that the loop may sleep.
  std::optional<std::int64_t> watchdog_interval_ms() const { return watchdog_interval_ms_; }

 private:
  std::optional<std::int64_t> watchdog_interval_ms_;
};

}  // namespace thind
