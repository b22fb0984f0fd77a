#include "daemon/status.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/folders.h"
#include "daemon/journal.h"
#include "libthin/observations/time.h"

namespace thind {
namespace {

using Json = nlohmann::ordered_json;

// Pending files whose bytes are neither in the spool nor, still or again, in the inbox.
Json missing_files(Journal& journal, const Folders& folders) {
  Json missing = Json::array();
  for (const FileState state : {FileState::seen, FileState::incomplete, FileState::staged})
    for (const FileRecord& file : journal.files(state)) {
      const bool may_be_in_inbox = state != FileState::staged && exists(folders.inbox + "/" + file.name);
      if (!may_be_in_inbox && !exists(folders.spooled(file.hash))) missing.push_back(file.name);
    }
  return missing;
}

Json file_counts(Journal& journal) {
  const FileCounts counts = journal.counts();
  return {{"seen", counts.seen},           {"published", counts.published},   {"quarantined", counts.quarantined},
          {"pending", counts.pending},     {"duplicates", counts.duplicates}, {"withdrawn", counts.withdrawn},
          {"balanced", counts.balanced()}, {"in_state", Json::object()}};
}

Json window_entry(const WindowRecord& window) {
  Json entry;
  const bool whole_file = window.kind == WindowKind::file;
  entry["name"] = whole_file ? window.output : window_name(window.interval, window.kind, window.version);
  entry["mode"] = whole_file ? "per_file" : "window";
  if (!whole_file) {
    entry["begin"] = thin::to_iso8601(window.interval.begin_ms);
    entry["end"] = thin::to_iso8601(window.interval.end_ms);
  }
  entry["state"] = name_of(window.state);
  entry["output"] = window.output;
  entry["reason"] = window.reason;
  entry["files"] = window.files;
  entry["late_dropped"] = window.dropped;
  entry["observations"] = window.observations;
  entry["retained"] = window.retained;
  entry["attempts"] = window.attempts;
  entry["seconds"] = Json::parse(window.seconds, nullptr, false);
  return entry;
}

std::string seconds_text(const Json& seconds) {
  std::string text;
  if (!seconds.is_object()) return text;
  for (const auto& [step, value] : seconds.items())
    if (value.is_number()) text += fmt::format("  {} {:.2f} s", step, value.get<double>());
  return text;
}

std::string text_of(const Json& status) {
  const Json& files = status["files"];
  const auto count = [&](const char* key) { return files[key].get<std::int64_t>(); };
  std::string text =
      fmt::format("files: seen {} {} published {} + quarantined {} + pending {}; further deliveries {}, withdrawn {}\n",
                  count("seen"), files["balanced"].get<bool>() ? "=" : "IS NOT", count("published"),
                  count("quarantined"), count("pending"), count("duplicates"), count("withdrawn"));
  for (const Json& name : status["missing"]) text += "MISSING: " + name.get<std::string>() + "\n";
  for (const Json& window : status["windows"]) {
    text += fmt::format("{:<40} {:<9} {} files  {} observations  {} retained{}", window["name"].get<std::string>(),
                        window["state"].get<std::string>(), window["files"].get<std::int64_t>(),
                        window["observations"].get<std::int64_t>(), window["retained"].get<std::int64_t>(),
                        seconds_text(window["seconds"]));
    if (const auto dropped = window["late_dropped"].get<std::int64_t>())
      text += fmt::format("  {} late dropped", dropped);
    if (const auto& reason = window["reason"].get_ref<const std::string&>(); !reason.empty())
      text += "  (" + reason + ")";
    text += "\n";
  }
  return text;
}

}  // namespace

Result<Status> read_status(const Settings& settings, bool json) {
  const Folders folders(settings.daemon);
  if (!exists(folders.journal()))
    return Error{ErrorKind::input, "there is no journal yet at " + folders.journal() + ": thind has not run here"};
  try {
    Journal journal(folders.journal(), Database::Access::read_only);
    Json status;
    // One read transaction: a daemon may be at work, and the counts are to be of one moment.
    journal.atomically_reading([&] {
      status["files"] = file_counts(journal);
      for (const FileState state :
           {FileState::seen, FileState::incomplete, FileState::staged, FileState::published, FileState::quarantined})
        status["files"]["in_state"][name_of(state)] = journal.files(state).size();
      status["windows"] = Json::array();
      for (const WindowRecord& window : journal.windows()) status["windows"].push_back(window_entry(window));
      status["missing"] = missing_files(journal, folders);
    });
    const bool consistent = status["files"]["balanced"].get<bool>() && status["missing"].empty();
    return Status{json ? status.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : text_of(status),
                  consistent};
  } catch (const JournalError& error) {
    return Error{ErrorKind::temporary, error.what()};
  }
}

}  // namespace thind
