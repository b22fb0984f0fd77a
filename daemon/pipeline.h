#pragma once

// From the spool to the outbox: plans from the journal which workers to start, and records what became of them. Nothing
// but the running workers is kept in memory, so that it can be rebuilt at any time from the journal.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/folders.h"
#include "daemon/intake.h"
#include "daemon/journal.h"
#include "daemon/settings.h"
#include "daemon/supervisor.h"
#include "daemon/worker_report.h"

namespace thind {

// What the windows wait for.
struct Closing {
  std::int64_t now_ms = 0;
  std::int64_t scanned_ms = 0;  // when the inbox was first looked at as a whole: what lay there counts as in time
  std::optional<std::int64_t> oldest_undecided_ms;
  bool close_all = false;  // there will be no more files: cut-offs are over
};

class Pipeline {
 public:
  Pipeline(const Settings& settings, const Folders& folders, Journal& journal, Intake& intake)
      : settings_(settings), folders_(folders), journal_(journal), intake_(intake) {}

  // Starts workers for what is due, as many as may run. Errors are the machine's making; the call is to be repeated.
  Result<void> start_due(const Closing& closing);

  // Records what workers have done that have ended; what the machine kept it from doing is put off.
  void collect();

  // Originals of decided files to archive, late or quarantine; what they had in staged/ goes.
  Result<void> settle();

  // When start_due() would find something new without any event, wall clock; nothing where never.
  std::optional<std::int64_t> next_due_ms(const Closing& closing);

  // Files are waiting to be decoded that have not been put off max_attempts times already.
  bool has_hopeful_work();

  Supervisor& workers() { return workers_; }

 private:
  struct Job {
    enum class Kind { ingest, window, probe } kind = Kind::ingest;
    std::string hash = {};     // ingest, probe
    std::int64_t window = 0;   // window, probe
    std::string folder = {};   // scratch
    std::string outputs = {};  // folder of the outputs: window, probe
    std::vector<std::string> members = {};
  };

  // ingest_step.cpp
  Result<void> start_ingest(const FileRecord& file);
  Result<void> finish_ingest(const Job& job, WorkerExit exit);
  Result<void> accept_staged(const FileRecord& file, const Job& job, IngestReport& report);
  void fail_ingest(const FileRecord& file, const WorkerReport& report);
  void give_up_ingest(const FileRecord& file, const std::string& reason, const WorkerReport* report);

  // window_step.cpp
  Result<void> start_window(const WindowRecord& window);
  Result<void> finish_window(const Job& job, WorkerExit exit);
  Result<void> publish(const WindowRecord& window, const Job& job, const WindowReport& report);
  // The attempt was not of the window's own making: it does not count, and the window waits.
  void put_off(const WindowRecord& window, const std::string& label, const WorkerReport& report);
  void fail_window(const WindowRecord& window, const WorkerReport& report);
  bool is_due(const WindowRecord& window, const Closing& closing);
  std::int64_t closing_time_of(const WindowRecord& window, const Closing& closing);

  // probing.cpp
  Result<void> start_probe(const WindowRecord& window);
  Result<void> finish_probe(const Job& job, WorkerExit exit);
  void end_probing(const WindowRecord& window);
  void remove_culprit(const WindowRecord& window, const FileRecord& file, const WorkerReport& report);

  // Shared.
  Result<void> start(Job job, std::vector<std::string> arguments);
  Result<Job> prepare(Job job) const;
  Result<void> write_plan(const Job& job, const WindowRecord& window, const std::vector<Member>& members) const;
  Result<std::string> configuration_for_workers() const;
  void excuse(const Job& job, const Error& error);
  std::int64_t retry_at(std::int64_t vain_attempts) const;
  // At once where the daemon itself has stopped the worker, later where someone else did.
  std::int64_t retry_after_stop(const WorkerExit& exit, std::int64_t deferrals) const;
  bool has_free_worker() const;

  const Settings& settings_;
  const Folders& folders_;
  Journal& journal_;
  Intake& intake_;
  Supervisor workers_;
  std::map<Supervisor::Key, Job> jobs_;
  std::int64_t last_job_ = 0;
};

}  // namespace thind
