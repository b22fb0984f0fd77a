#pragma once

// Files that can't be used: decided in the journal first, with everything that is known, then laid into the quarantine
// with that as NAME.reason.json.

#include <string>

#include "daemon/folders.h"
#include "daemon/journal.h"
#include "daemon/worker_report.h"

namespace thind {

// Records it, logs it, and takes the file out of its unfinished windows. report: of the worker that failed at it;
// nullptr where none did.
void quarantine_file(Journal& journal, const FileRecord& file, const std::string& reason, const WorkerReport* report);

// Moves the file from the spool into the quarantine, beside its reason; returns its path there.
Result<std::string> settle_quarantined(const Folders& folders, const FileRecord& file);

std::string reason_path(const std::string& quarantined);

}  // namespace thind
