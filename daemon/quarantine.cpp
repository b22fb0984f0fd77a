#include "daemon/quarantine.h"

#include <nlohmann/json.hpp>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "libthin/foundation/version.h"
#include "libthin/observations/time.h"

namespace thind {
namespace {

using Json = nlohmann::ordered_json;

std::string evidence_of(const FileRecord& file, const std::string& reason, const WorkerReport* report) {
  Json evidence;
  evidence["file"] = file.name;
  evidence["reason"] = file.name + " " + reason;
  evidence["sha256"] = file.hash;
  evidence["bytes"] = file.size_bytes;
  evidence["seen"] = thin::to_iso8601(file.seen_ms);
  evidence["quarantined"] = thin::to_iso8601(wall_clock_ms());
  evidence["attempts"] = file.attempts;
  evidence["interruptions"] = file.interruptions;
  if (report) {
    evidence["outcome"] = name_of(report->outcome);
    if (report->exit.exit_code) evidence["exit_code"] = *report->exit.exit_code;
    if (report->exit.signal) evidence["signal"] = *report->exit.signal;
    evidence["timed_out"] = report->exit.timed_out;
    evidence["last_errors"] = report->exit.last_errors;
  }
  evidence["version"] = thin::kVersion;
  return evidence.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

void quarantine_file(Journal& journal, const FileRecord& file, const std::string& reason, const WorkerReport* report) {
  // Attempts are counted in the journal while they run, so the record in hand may be older.
  FileRecord now = journal.file(file.hash).value_or(file);
  journal.record_quarantined(file.hash, reason, evidence_of(now, reason, report), wall_clock_ms());
  log(Level::error, file.name + " quarantined: it " + reason,
      {{"file", file.name}, {"outcome", "quarantined"}, {"sha256", file.hash}});
}

Result<std::string> settle_quarantined(const Folders& folders, const FileRecord& file) {
  auto placed = place_file(folders.spooled(file.hash), folders.quarantine, file.name, file.hash);
  if (!placed) return placed;
  if (auto written = write_file(reason_path(*placed), file.evidence); !written) return written.error();
  return placed;
}

std::string reason_path(const std::string& quarantined) {
  return quarantined + ".reason.json";
}

}  // namespace thind
