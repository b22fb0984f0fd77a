#pragma once

// [daemon] and [window] of the configuration; the other sections are the worker's. Each option is explained where it is
// declared (settings.cpp), and from there in docs/operations.md.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/windows.h"
#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"

namespace thind {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

enum class Level { debug, information, warning, error };

struct LogSettings {
  enum class Format { text, json };
  Level level = Level::information;
  Format format = Format::text;
  std::string file;  // empty: standard error
  int file_megabytes = 16;
  int file_count = 5;
};

struct DaemonSettings {
  std::string root = "/var/lib/thind";
  std::string inbox, outbox, archive, quarantine, late, state;  // empty: of that name in root
  std::string worker;                                           // empty: see find_worker
  bool poll_only = false;
  double rescan_seconds = 30;
  double settle_seconds = 2;
  std::vector<std::string> ignore_suffixes = {".tmp", ".part", ".filepart", ".lock"};
  double max_wait_seconds = 1800;
  int max_attempts = 3;
  int max_interruptions = 10;
  double retry_seconds = 10;
  int parallel_workers = 0;  // 0: as many as there are cores
  double worker_timeout_seconds = 600;
  int worker_memory_megabytes = 4096;
  int worker_file_megabytes = 16384;
  double stop_timeout_seconds = 20;
  int max_windows_per_file = 16;
  std::optional<double> keep_archive_days;
  LogSettings log;

  void declare(thin::OptionTable& table);
};

struct WindowSettings {
  enum class Mode { window, per_file };
  enum class Late { rethin, separate, drop };
  Mode mode = Mode::window;
  Late late = Late::rethin;
  double length_minutes = 180;
  double anchor_minutes = 0;
  double cutoff_minutes = 60;
  double quiet_seconds = 30;
  std::vector<std::string> expected_platforms;
  std::set<int> expected_platform_numbers;  // read from the names

  WindowGrid grid() const;
  ClosingRule closing_rule() const;
  void declare(thin::OptionTable& table);
};

struct Settings {
  std::string path;  // of the configuration
  std::string text;  // its content
  DaemonSettings daemon;
  WindowSettings window;
};

// Reads both sections, makes paths absolute (relative ones start at the configuration's folder) and finds the worker.
// Errors: configuration, one line per problem, with file and line.
Result<Settings> read_settings(const std::string& path);

// What a running daemon can't take over from a new configuration (its folders); nothing where all can be.
std::optional<std::string> unchangeable_difference(const Settings& running, const Settings& wanted);

}  // namespace thind
