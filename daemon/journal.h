#pragma once

// What the daemon knows, in SQLite on local disk: every step is planned from here and recorded here, so that a daemon
// that was killed anywhere goes on where it was.
//
// A file is its content (SHA-256). Each seen content is in exactly one state:
//
//     seen ------> staged ------> published      every window of the file is done
//      |  ^          |                           (outcome: retained, nothing retained, late and dropped)
//      v  |          v
//   incomplete -> quarantined                    can't be used, or failed too often (the record says why)
//
//   seen         taken from the inbox (spool/HASH), or about to be; waits for `thin ingest`
//   incomplete   `thin ingest` found its end cut off: back in the inbox under its name, until it grows or max_wait is
//   over staged       decoded (staged/HASH.nc), member of its windows quarantined  a redelivery of the same content
//   starts again at seen
//
// pending = seen + incomplete + staged, and seen contents = published + quarantined + pending. `settled` says whether
// the bytes of a published or quarantined file have reached archive/ or quarantine/.
//
// A window is a run of `thin window`: of a time interval, of late data for one, or of one file (per-file mode):
//
//     open ------> published | empty | failed    empty: nothing was left to retain
//      |  ^
//      v  |
//     probing                                    failed too often: each member is tried alone, to find the culprit
//
// `attempts` counts failures of the work's own making. It is raised, and `running` set, before the worker starts; what
// says later that it was not the work's making (temporary, stopped) lowers it again. A daemon that died meanwhile
// leaves `running`, which is then counted as an interruption.
//
// All functions throw JournalError. Times: wall clock, ms.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/database.h"
#include "daemon/windows.h"

namespace thind {

enum class FileState { seen, incomplete, staged, published, quarantined };
enum class WindowState { open, probing, published, empty, failed };

const char* name_of(FileState state);
const char* name_of(WindowState state);

struct FileRecord {
  std::string hash;
  std::string name;  // in the inbox
  std::int64_t size_bytes = 0;
  FileState state = FileState::seen;
  std::string outcome;   // one sentence
  std::string evidence;  // quarantined: the reason file's content (JSON)
  std::int64_t attempts = 0;
  std::int64_t interruptions = 0;
  std::int64_t deferrals = 0;
  std::int64_t not_before_ms = 0;
  std::int64_t seen_ms = 0;
  std::optional<std::int64_t> first_ms;  // of its observations, inclusive
  std::optional<std::int64_t> last_ms;
  std::int64_t observations = 0;
  std::vector<int> platforms;
  bool staged = false;   // staged/HASH.nc is there
  bool settled = false;  // the original is at `location`
  std::string location;  // where settled
};

struct WindowRecord {
  std::int64_t id = 0;
  WindowKind kind = WindowKind::window;
  Interval interval;  // zero for kind file
  int version = 1;
  WindowState state = WindowState::open;
  std::string output;  // name in the outbox, once published
  std::string reason;
  std::int64_t attempts = 0;
  std::int64_t interruptions = 0;
  std::int64_t deferrals = 0;
  std::int64_t not_before_ms = 0;
  std::int64_t last_arrival_ms = 0;
  std::int64_t observations = 0;
  std::int64_t retained = 0;
  std::int64_t dropped = 0;   // late files that were not taken in
  std::int64_t culprits = 0;  // members that probing has taken out
  bool running = false;       // a worker is at it
  std::string seconds;        // JSON: per step
  std::int64_t files = 0;
};

// The outcome of a file all of whose windows were closed when it came.
inline constexpr const char* kLateOutcome = "late and dropped";

enum class Probe { none, passed };

struct Member {
  FileRecord file;
  Probe probe = Probe::none;
};

struct Staged {
  std::int64_t first_ms = 0, last_ms = 0, observations = 0;
  std::vector<int> platforms;
};

struct WindowOutcome {
  WindowState state = WindowState::published;
  int version = 1;  // of the output
  std::string output = {}, reason = {};
  std::int64_t observations = 0, retained = 0;
  std::string seconds = "{}";
};

struct FileCounts {
  std::int64_t seen = 0;  // counted when it happens, not from the states: the two must agree
  std::int64_t published = 0, quarantined = 0, pending = 0;
  std::int64_t duplicates = 0;  // further deliveries of a content
  std::int64_t withdrawn = 0;   // removed by the sender before they were complete; not in `seen`
  bool balanced() const { return seen == published + quarantined + pending; }
};

class Journal {
 public:
  Journal(const std::string& path, Database::Access access);

  void atomically(const std::function<void()>& steps) { database_.atomically(steps); }

  // All reads see the state of one moment.
  void atomically_reading(const std::function<void()>& steps) { database_.atomically_reading(steps); }

  // Grows with every recorded change.
  std::int64_t changes() const { return database_.changes(); }

  // Files.
  std::optional<FileRecord> file(const std::string& hash);
  std::vector<FileRecord> files(FileState state);
  // Decided, in no unfinished window, and something of them is still in the spool or in staged/.
  std::vector<FileRecord> unsettled();
  // For `thin ingest`: seen, or not staged and in an open window; no worker at it. Those that are due, oldest first.
  std::vector<FileRecord> to_ingest(std::int64_t now_ms, std::size_t limit);
  // When the next of them is due, which may be in the past; nothing where there is none.
  std::optional<std::int64_t> next_ingest_ms();
  struct IngestCounts {
    std::int64_t waiting = 0;  // or at work
    std::int64_t hopeful = 0;  // of these, put off fewer than max_deferrals times
  };
  IngestCounts ingest_counts(std::int64_t max_deferrals);
  // When the first of the seen and the incomplete was seen.
  std::optional<std::int64_t> oldest_undecided_ms();
  FileCounts counts();

  void record_seen(const std::string& hash, const std::string& name, std::int64_t size_bytes, std::int64_t now_ms);
  void record_duplicate();
  // quarantined -> seen: the same content was delivered again.
  void record_retry(const std::string& hash, const std::string& name);
  // seen -> incomplete.
  void record_incomplete(const std::string& hash, const std::string& reason);
  // An incomplete file has grown into other content: it stays the same delivery.
  void record_growth(const std::string& old_hash, const std::string& new_hash, std::int64_t size_bytes);
  // The bytes left before they were the daemon's: forget the file.
  void record_withdrawal(const std::string& hash);
  // seen -> staged (or staged anew for a later version of a window).
  void record_staged(const std::string& hash, const Staged& staged);
  void record_unstaged(const std::string& hash);
  void record_quarantined(const std::string& hash, const std::string& outcome, const std::string& evidence,
                          std::int64_t now_ms);
  void record_settled(const std::string& hash, const std::string& location);

  void begin_file_attempt(const std::string& hash);
  // It counts as a failure, or it does not.
  void end_file_attempt(const std::string& hash, std::int64_t not_before_ms);
  void excuse_file_attempt(const std::string& hash, std::int64_t not_before_ms);

  // Windows.
  std::vector<WindowRecord> windows();
  std::vector<WindowRecord> unfinished_windows();
  std::optional<WindowRecord> window(std::int64_t id);
  std::optional<WindowRecord> latest_window(WindowKind kind, const Interval& interval);
  std::int64_t create_window(WindowKind kind, const Interval& interval, int version, std::int64_t now_ms);
  void add_member(std::int64_t window, const std::string& hash, std::int64_t now_ms);
  // The file is late for the window and stays out of it.
  void add_dropped(std::int64_t window, const std::string& hash);
  bool all_members_staged(std::int64_t window);
  // Of any kind but file: whether an earlier output for the interval is still to come.
  bool has_unfinished_before(const WindowRecord& window);
  std::vector<Member> members(std::int64_t window);  // by name, then hash
  bool is_member_of_unfinished(const std::string& hash);
  void leave_unfinished_windows(const std::string& hash);

  void begin_window_attempt(std::int64_t window);
  void end_window_attempt(std::int64_t window, const std::string& reason, std::int64_t not_before_ms);
  void excuse_window_attempt(std::int64_t window, std::int64_t not_before_ms);
  void begin_probing(std::int64_t window);
  void record_probe_passed(std::int64_t window, const std::string& hash);
  // Takes the member out of this window. To quarantine it is the caller's next step, in the same transaction.
  void record_culprit(std::int64_t window, const std::string& hash);
  // probing -> open, without its culprits, with all attempts before it.
  void end_probing(std::int64_t window);
  // Also publishes those members whose last unfinished window it was.
  void record_outcome(std::int64_t window, const WindowOutcome& outcome, std::int64_t now_ms);
  // Publishes a staged file that is in no unfinished window; what the windows made of it is its outcome.
  void publish_if_done(const std::string& hash, std::int64_t now_ms);

  // After a start: what was running is an interruption, not a failure; what was put off is tried at once.
  void count_interruptions();

  // Ever; a retry after a quarantine that ends there again counts anew.
  std::int64_t quarantined_ever() { return count_of("quarantined"); }

  std::string fact(const std::string& name);
  void set_fact(const std::string& name, const std::string& value);

 private:
  std::int64_t count_of(const std::string& counter);
  void count(const std::string& counter, std::int64_t change);

  Database database_;
};

}  // namespace thind
