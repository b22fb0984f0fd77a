#pragma once

// Worker processes: started with limits, watched without blocking, killed when their time is over, and heard to the
// end. A worker runs in a process group of its own that dies with it, and it dies with the daemon.

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/clock.h"
#include "daemon/descriptor.h"
#include "libthin/foundation/result.h"

namespace thind {

struct WorkerLimits {
  double wall_seconds = 600;
  std::int64_t memory_bytes = 0;  // address space; 0: no limit
  std::int64_t cpu_seconds = 0;   // of all threads together; 0: no limit
  std::int64_t file_bytes = 0;    // of one written file; 0: no limit
};

struct WorkerCommand {
  std::vector<std::string> arguments;  // arguments[0]: the program's path
  WorkerLimits limits;
};

struct WorkerExit {
  std::optional<int> exit_code;
  std::optional<int> signal;  // that it died of
  bool timed_out = false;     // the signal was ours: its time was over
  bool stopped = false;       // the signal was ours: the daemon stops
  std::string output;         // standard output, at most kOutputBytes of it
  bool output_cut = false;
  std::string last_errors;  // the last kErrorBytes of standard error
  double seconds = 0;
};

inline constexpr std::size_t kOutputBytes = std::size_t{4} << 20;
inline constexpr std::size_t kErrorBytes = std::size_t{8} << 10;

// Exit status of a child that could not become the worker.
inline constexpr int kExitNotStarted = 126;

class Supervisor {
 public:
  using Key = std::int64_t;

  Supervisor() = default;
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  // Errors: temporary, where the machine gives no process or descriptor.
  thin::Result<Key> start(const WorkerCommand& command);

  std::size_t running() const { return workers_.size(); }

  // Descriptors that become readable when something is to be collected, and the time at which to do so anyhow.
  void add_to_poll(std::vector<pollfd>& descriptors) const;
  std::optional<MonotonicTime> next_deadline() const;

  // Reads what workers said, kills those whose time is over, and returns those that ended. Never blocks.
  std::vector<std::pair<Key, WorkerExit>> collect();

  // Ends all workers: by SIGTERM, or by SIGKILL. They are still to be collected, as stopped.
  void stop_all(int signal);

 private:
  struct Worker {
    pid_t process = 0;
    Descriptor process_descriptor, output, errors;
    MonotonicTime started, deadline;
    WorkerExit exit;
  };
  static void read_pipes(Worker& worker);
  static bool reap(Worker& worker);

  Key last_key_ = 0;
  std::map<Key, Worker> workers_;
};

// Starts the worker and waits for its end.
thin::Result<WorkerExit> run_worker(const WorkerCommand& command);

}  // namespace thind
