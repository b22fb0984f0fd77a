#pragma once

// What `thind --status` says, read from the journal alone, also while a daemon runs.

#include <string>

#include "daemon/settings.h"

namespace thind {

struct Status {
  std::string text;
  bool consistent = true;  // seen = published + quarantined + pending, and everything pending is there
};

// Errors: input, where there is no journal yet; temporary, where it can't be read.
Result<Status> read_status(const Settings& settings, bool json);

}  // namespace thind
