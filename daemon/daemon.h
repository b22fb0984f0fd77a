#pragma once

// The loop: waits for signals, the inbox, workers and clocks, and lets intake and pipeline do what is due. It sleeps
// until then, and nothing in it waits for one thing alone.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/folders.h"
#include "daemon/intake.h"
#include "daemon/journal.h"
#include "daemon/lock.h"
#include "daemon/notification.h"
#include "daemon/patience.h"
#include "daemon/pipeline.h"
#include "daemon/settings.h"

namespace thind {

inline constexpr int kExitQuarantined = 3;
inline constexpr int kExitPending = 75;
inline constexpr int kExitStopped = 143;

// Lets the worker check its own sections. Errors: configuration, with file and line; temporary, where it can't be run.
Result<void> check_with_worker(const Settings& settings);

class Daemon {
 public:
  // once: drain the inbox, close all windows, and end.
  Daemon(Settings settings, bool once);

  // Until a signal ends it (kExitStopped) or, with once, the work does: 0; kExitPending where something stays pending;
  // kExitQuarantined where something went to quarantine in this call. Errors are those of the start.
  Result<int> run();

 private:
  // Rebuilt as a whole after the journal has failed.
  struct Work {
    Work(const Settings& settings, const Folders& folders)
        : journal(folders.journal(), Database::Access::read_write),
          intake(settings, folders, journal),
          pipeline(settings, folders, journal, intake) {}
    Journal journal;
    Intake intake;
    Pipeline pipeline;
    std::optional<std::int64_t> scanned_ms;
  };

  Result<void> set_up();
  Result<void> begin_work();
  void turn();
  void step();
  void wait();
  void take_signals();
  void reload();
  void begin_stop();
  Closing closing();
  std::int64_t milliseconds_to_wait();
  bool is_over();
  int exit_status();
  void purge_archive_if_due(MonotonicTime now);
  void journal_failed(const std::string& why);

  Settings settings_;
  bool once_;
  Folders folders_;
  Lock state_lock_, inbox_lock_;
  Descriptor signals_;
  Notification notification_;
  std::unique_ptr<Work> work_;
  Patience journal_patience_, intake_patience_, start_patience_, settle_patience_;
  std::optional<MonotonicTime> stop_deadline_, next_purge_;
  std::int64_t changes_ = 0;             // of the journal, when the last turn ended
  std::int64_t quarantined_before_ = 0;  // this call
  bool busy_ = true;                     // the last turn changed something: the next may find more to do
};

}  // namespace thind
