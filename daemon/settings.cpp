#include "daemon/settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <thread>
#include <tuple>

#include "daemon/clock.h"
#include "daemon/file_system.h"
#include "daemon/log.h"
#include "libthin/foundation/configuration.h"
#include "libthin/observations/platforms.h"

namespace thind {
namespace {

namespace fs = std::filesystem;

// `thin` beside this program, else the first in PATH; empty where there is none.
std::string find_worker() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::string beside = (program.parent_path() / "thin").string();
  if (!error && ::access(beside.c_str(), X_OK) == 0) return beside;
  const char* search_path = std::getenv("PATH");
  std::istringstream folders(search_path ? search_path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::string candidate = folder + "/thin";
    if (!folder.empty() && ::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

void make_absolute(std::string& path, const fs::path& base) {
  if (!path.empty()) path = (base / path).lexically_normal().string();
}

void complete_paths(DaemonSettings& daemon, const fs::path& base) {
  make_absolute(daemon.root, base);
  const std::pair<std::string*, const char*> folders[] = {
      {&daemon.inbox, "inbox"},           {&daemon.outbox, "outbox"}, {&daemon.archive, "archive"},
      {&daemon.quarantine, "quarantine"}, {&daemon.late, "late"},     {&daemon.state, "state"}};
  for (const auto& [path, name] : folders) {
    if (path->empty()) *path = daemon.root + "/" + name;
    make_absolute(*path, base);
    // "in/" and "in" are one folder.
    while (path->size() > 1 && path->back() == '/') path->pop_back();
  }
  make_absolute(daemon.worker, base);
  make_absolute(daemon.log.file, base);
}

void check_folders(const DaemonSettings& daemon, thin::Configuration& configuration) {
  const std::pair<const char*, const std::string*> folders[] = {
      {"inbox", &daemon.inbox},           {"outbox", &daemon.outbox}, {"archive", &daemon.archive},
      {"quarantine", &daemon.quarantine}, {"late", &daemon.late},     {"state", &daemon.state}};
  for (const auto& [name, path] : folders)
    for (const auto& [other_name, other_path] : folders)
      if (std::string_view(name) < other_name && *path == *other_path)
        configuration.add_problem("daemon", name,
                                  "is the same folder as daemon." + std::string(other_name) + " (" + *path +
                                      "): give each a folder of its own");
}

void check_worker(DaemonSettings& daemon, thin::Configuration& configuration) {
  if (daemon.worker.empty()) daemon.worker = find_worker();
  if (daemon.worker.empty())
    configuration.add_problem("daemon", "worker", "is unset, and there is no `thin` beside thind nor in PATH");
  else if (::access(daemon.worker.c_str(), X_OK) != 0)
    configuration.add_problem("daemon", "worker", "is not a program that can be run: " + daemon.worker);
}

void read_platforms(WindowSettings& window, thin::Configuration& configuration) {
  for (const std::string& name : window.expected_platforms) {
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size())
      window.expected_platform_numbers.insert(number);
    else if (const auto known = thin::platform_number(name))
      window.expected_platform_numbers.insert(*known);
    else
      configuration.add_problem(
          "window", "expected_platforms",
          "has the unknown platform \"" + name + "\": write a name like \"Metop-B\" or its WMO number like \"3\"");
  }
}

}  // namespace

void DaemonSettings::declare(thin::OptionTable& table) {
  table.add("root", root, {.explanation = "folder of all those below that are not set"});
  table.add("inbox", inbox, {.explanation = "watched for new files; default: root/inbox"});
  table.add("outbox", outbox, {.explanation = "where outputs appear, whole or not at all; default: root/outbox"});
  table.add("archive", archive, {.explanation = "originals of what was published; default: root/archive"});
  table.add("quarantine", quarantine,
            {.explanation = "what can't be used, each with its FILE.reason.json; default: root/quarantine"});
  table.add("late", late, {.explanation = "late files where window.late = \"drop\"; default: root/late"});
  table.add("state", state, {.explanation = "journal, spool and work in progress, on local disk; default: root/state"});
  table.add("worker", worker, {.explanation = "the program `thin`; default: beside thind, else in PATH"});
  table.add("poll_only", poll_only,
            {.explanation = "look only every rescan_seconds: for inboxes on network file systems"});
  table.add("rescan_seconds", rescan_seconds,
            {.unit = "s", .above = 0, .explanation = "between looks at the whole inbox, whatever the kernel reports"});
  table.add(
      "settle_seconds", settle_seconds,
      {.unit = "s", .minimum = 0, .explanation = "size and time of a file must rest this long before it is taken"});
  table.add("ignore_suffixes", ignore_suffixes,
            {.explanation = "names that senders give to files that they still write; names with a leading dot always"});
  table.add("max_wait_seconds", max_wait_seconds,
            {.unit = "s", .minimum = 0, .explanation = "after which an incomplete or empty file goes to quarantine"});
  table.add("max_attempts", max_attempts,
            {.minimum = 1, .explanation = "failures of a file's own making (crash, time over) until quarantine"});
  table.add("max_interruptions", max_interruptions,
            {.minimum = 1, .explanation = "deaths of the whole daemon during work on one file until its quarantine"});
  table.add(
      "retry_seconds", retry_seconds,
      {.unit = "s", .above = 0, .explanation = "before the next attempt; doubled up to 32-fold while it is in vain"});
  table.add("parallel_workers", parallel_workers, {.minimum = 0, .explanation = "0: as many as there are cores"});
  table.add("worker_timeout_seconds", worker_timeout_seconds,
            {.unit = "s", .above = 0, .explanation = "after which a worker is ended"});
  table.add("worker_memory_megabytes", worker_memory_megabytes,
            {.unit = "MiB", .minimum = 0, .explanation = "address space of one worker; 0: no limit"});
  table.add("worker_file_megabytes", worker_file_megabytes,
            {.unit = "MiB", .minimum = 0, .explanation = "size of a file that a worker writes; 0: no limit"});
  table.add("stop_timeout_seconds", stop_timeout_seconds,
            {.unit = "s", .minimum = 0, .explanation = "for workers to finish after SIGTERM"});
  table.add("max_windows_per_file", max_windows_per_file,
            {.minimum = 1, .explanation = "a file whose times span more windows has wrong times: quarantine"});
  table.add("keep_archive_days", keep_archive_days,
            {.unit = "d", .minimum = 0, .explanation = "after which archived originals are deleted; unset: never"});
  table.add_choice<Level>("log_level", log.level,
                          {{"debug", Level::debug},
                           {"information", Level::information},
                           {"warning", Level::warning},
                           {"error", Level::error}},
                          {.explanation = "least level that is written"});
  table.add_choice<LogSettings::Format>("log_format", log.format,
                                        {{"text", LogSettings::Format::text}, {"json", LogSettings::Format::json}},
                                        {.explanation = "text for people, JSON lines for machines"});
  table.add("log_file", log.file, {.explanation = "default: standard error, which systemd keeps"});
  table.add("log_file_megabytes", log.file_megabytes,
            {.unit = "MiB", .minimum = 1, .maximum = 4096, .explanation = "after which log_file is rotated"});
  table.add("log_file_count", log.file_count,
            {.minimum = 1, .maximum = 1000, .explanation = "rotated files that are kept"});
}

WindowGrid WindowSettings::grid() const {
  return {milliseconds(length_minutes * 60), milliseconds(anchor_minutes * 60)};
}

ClosingRule WindowSettings::closing_rule() const {
  return {milliseconds(cutoff_minutes * 60), milliseconds(quiet_seconds)};
}

void WindowSettings::declare(thin::OptionTable& table) {
  table.add_choice<Mode>("mode", mode, {{"window", Mode::window}, {"per_file", Mode::per_file}},
                         {.explanation = "thin all files of a time window together, or each file by itself"});
  table.add("length_minutes", length_minutes,
            {.unit = "min", .minimum = 1, .maximum = 60 * 24 * 366, .explanation = "length of a window"});
  table.add(
      "anchor_minutes", anchor_minutes,
      {.unit = "min",
       .explanation = "windows are counted from midnight UTC plus this; -90 with length 180 centres on 00, 03, ..."});
  table.add("cutoff_minutes", cutoff_minutes,
            {.unit = "min", .explanation = "after a window's end, by the wall clock, it is closed"});
  table.add("quiet_seconds", quiet_seconds,
            {.unit = "s", .minimum = 0, .explanation = "without a new file for the window before it is closed"});
  table.add("expected_platforms", expected_platforms,
            {.explanation = "once all of them are there a window closes before its cut-off; names or WMO numbers"});
  table.add_choice<Late>("late", late, {{"rethin", Late::rethin}, {"separate", Late::separate}, {"drop", Late::drop}},
                         {.explanation = "data for a closed window: thin the window again with it (.v2), thin it "
                                         "alone (.late1), or put it into daemon.late"});
}

Result<Settings> read_settings(const std::string& path) {
  Settings settings;
  std::error_code error;
  settings.path = fs::absolute(path, error).lexically_normal().string();
  auto text = read_file(settings.path);
  auto configuration = text ? thin::Configuration::parse(*text, path) : thin::Configuration::read(path);
  if (!configuration) return configuration.error();
  if (text) settings.text = *text;

  thin::OptionTable daemon_table, window_table;
  settings.daemon.declare(daemon_table);
  settings.window.declare(window_table);
  configuration->read_section("daemon", daemon_table);
  configuration->read_section("window", window_table);
  for (const char* section :
       {"thinning", "preparation", "output", "run", "input", "evaluate", "synthetic", "twin", "cycle"})
    configuration->ignore_section(section);

  complete_paths(settings.daemon, fs::path(settings.path).parent_path());
  check_folders(settings.daemon, *configuration);
  check_worker(settings.daemon, *configuration);
  read_platforms(settings.window, *configuration);
  if (auto fine = configuration->finish(); !fine) return fine.error();
  if (settings.daemon.parallel_workers == 0)
    settings.daemon.parallel_workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return settings;
}

std::optional<std::string> unchangeable_difference(const Settings& running, const Settings& wanted) {
  const DaemonSettings &a = running.daemon, &b = wanted.daemon;
  const std::tuple<const char*, const std::string&, const std::string&> folders[] = {
      {"inbox", a.inbox, b.inbox},       {"outbox", a.outbox, b.outbox},
      {"archive", a.archive, b.archive}, {"quarantine", a.quarantine, b.quarantine},
      {"late", a.late, b.late},          {"state", a.state, b.state}};
  for (const auto& [name, old_path, new_path] : folders)
    if (old_path != new_path)
      return fmt::format("daemon.{} can't change from {} to {} while thind runs: restart it", name, old_path, new_path);
  return std::nullopt;
}

}  // namespace thind
