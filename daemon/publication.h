#pragma once

// How outputs appear: whole or not at all, and never in the place of something else that has been published.

#include <functional>
#include <string>

#include "daemon/file_system.h"
#include "daemon/worker_report.h"

namespace thind {

// The folder holds the outputs that the report lists, with the sizes that it lists, its report.json, and nothing else.
// Errors: internal, what is missing or too much.
Result<void> validate_outputs(const std::string& folder, const WindowReport& report);

// Publishes the folder as outbox/NAME by one rename, after everything in it is on the disk. Where NAME is there already
// with the same content (the daemon died after publishing it) the folder is removed and that is that; with other
// content the next version is tried: name(version), name(version + 1), ... Returns the version published.
Result<int> publish_folder(const std::string& folder, const std::string& outbox, int version,
                           const std::function<std::string(int)>& name);

// Publishes the only output as outbox/NAME, with a part of its hash in the name where other content is there, and
// before it the report as outbox/reports/NAME.json. Returns the name. REQUIRES: one output in `report`, validated
Result<std::string> publish_file(const std::string& folder, const std::string& outbox, const WindowReport& report);

}  // namespace thind
