#pragma once

// What a worker's end means: its exit status and the one JSON object that it writes, read with suspicion. The process
// may have died anywhere and may have written anything.

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/journal.h"
#include "daemon/supervisor.h"

namespace thind {

enum class Outcome {
  done,
  unusable,       // exit 3: this input can't be used, now or ever
  incomplete,     // exit 75: the end of the input is cut off
  temporary,      // exit 75, or no process could be had: the machine's making
  configuration,  // exit 2: nobody's data is to blame
  stopped,        // the daemon, or someone else by SIGTERM, ended it
  failed,         // crash, time over, exit 1, or words that make no sense: the input's own making
};

const char* name_of(Outcome outcome);

struct WorkerReport {
  Outcome outcome = Outcome::failed;
  std::string reason;  // a sentence for people; empty where done
  WorkerExit exit;
};

struct IngestReport : WorkerReport {
  Staged staged;
  std::int64_t skipped = 0;
};

struct OutputFile {
  std::string name;
  std::int64_t bytes = 0;
  std::int64_t retained = 0;
};

struct WindowReport : WorkerReport {
  std::int64_t observations = 0;
  std::int64_t retained = 0;
  std::vector<OutputFile> outputs;
  std::string report;   // file name
  std::string seconds;  // JSON object
};

IngestReport read_ingest_report(WorkerExit exit);
WindowReport read_window_report(WorkerExit exit);

// "was ended by signal 11 (Segmentation fault)", "ran longer than allowed (600 s)", "exited with 1".
std::string describe(const WorkerExit& exit);

}  // namespace thind
