#pragma once

// The daemon's log: one line per event, as text for people or as JSON for machines.

#include <string>
#include <utility>
#include <vector>

#include "daemon/settings.h"

namespace thind {

// Names and values that the JSON line has besides the text; in the text form the sentence alone says it.
using Fields = std::vector<std::pair<std::string, std::string>>;

// To standard error, or to the file that the settings name. Errors: the file can't be opened.
thin::Result<void> set_up_log(const LogSettings& settings);

void log(Level level, const std::string& sentence, const Fields& fields = {});

}  // namespace thind
