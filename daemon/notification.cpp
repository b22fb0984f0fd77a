#include "daemon/notification.h"

#include <systemd/sd-daemon.h>
#include <time.h>

namespace thind {

Notification::Notification() {
  std::uint64_t microseconds = 0;
  if (sd_watchdog_enabled(0, &microseconds) > 0) watchdog_interval_ms_ = static_cast<std::int64_t>(microseconds / 3000);
}

void Notification::ready(const std::string& status) const {
  sd_notifyf(0, "READY=1\nSTATUS=%s", status.c_str());
}

void Notification::reloading() const {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const auto microseconds = static_cast<unsigned long long>(now.tv_sec) * 1'000'000 + now.tv_nsec / 1000;
  sd_notifyf(0, "RELOADING=1\nMONOTONIC_USEC=%llu", microseconds);
}

void Notification::stopping() const {
  sd_notify(0, "STOPPING=1");
}

void Notification::alive() const {
  if (watchdog_interval_ms_) sd_notify(0, "WATCHDOG=1");
}

}  // namespace thind
