#pragma once

// A step that the machine keeps from succeeding (disk full, folder gone) is tried again after a while, and spoken of
// once, not every time.

#include <chrono>
#include <optional>
#include <string>

#include "daemon/log.h"
#include "libthin/foundation/result.h"

namespace thind {

class Patience {
 public:
  using Time = std::chrono::steady_clock::time_point;

  bool may_try(Time now) const { return !next_try_ || now >= *next_try_; }
  std::optional<Time> next_try() const { return next_try_; }

  void note(const thin::Result<void>& result, Time now, double retry_seconds) {
    if (result) {
      if (next_try_) log(Level::information, "going on after: " + last_message_);
      next_try_.reset();
      last_message_.clear();
      return;
    }
    next_try_ = now + std::chrono::milliseconds(static_cast<std::int64_t>(retry_seconds * 1000));
    if (result.error().message == last_message_) return;
    last_message_ = result.error().message;
    log(Level::error, last_message_ + "; trying again");
  }

 private:
  std::optional<Time> next_try_;
  std::string last_message_;
};

}  // namespace thind
