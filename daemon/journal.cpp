#include "daemon/journal.h"

#include <array>
#include <sstream>

namespace thind {
namespace {

constexpr int kSchemaVersion = 1;

constexpr const char* kSchema = R"sql(
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE files (
  hash TEXT PRIMARY KEY, name TEXT NOT NULL, size INTEGER NOT NULL, state TEXT NOT NULL,
  outcome TEXT NOT NULL DEFAULT '', evidence TEXT NOT NULL DEFAULT '',
  attempts INTEGER NOT NULL DEFAULT 0, interruptions INTEGER NOT NULL DEFAULT 0, running INTEGER NOT NULL DEFAULT 0,
  deferrals INTEGER NOT NULL DEFAULT 0, not_before_ms INTEGER NOT NULL DEFAULT 0,
  seen_ms INTEGER NOT NULL, decided_ms INTEGER, first_ms INTEGER, last_ms INTEGER,
  observations INTEGER NOT NULL DEFAULT 0, platforms TEXT NOT NULL DEFAULT '',
  staged INTEGER NOT NULL DEFAULT 0, settled INTEGER NOT NULL DEFAULT 0, location TEXT NOT NULL DEFAULT ''
) WITHOUT ROWID;
CREATE INDEX files_by_state ON files (state, settled);
CREATE TABLE windows (
  id INTEGER PRIMARY KEY, kind TEXT NOT NULL, begin_ms INTEGER NOT NULL, end_ms INTEGER NOT NULL,
  version INTEGER NOT NULL, state TEXT NOT NULL DEFAULT 'open', output TEXT NOT NULL DEFAULT '',
  reason TEXT NOT NULL DEFAULT '', attempts INTEGER NOT NULL DEFAULT 0, interruptions INTEGER NOT NULL DEFAULT 0,
  running INTEGER NOT NULL DEFAULT 0, deferrals INTEGER NOT NULL DEFAULT 0, not_before_ms INTEGER NOT NULL DEFAULT 0,
  culprits INTEGER NOT NULL DEFAULT 0, opened_ms INTEGER NOT NULL, last_arrival_ms INTEGER NOT NULL, closed_ms INTEGER,
  observations INTEGER NOT NULL DEFAULT 0, retained INTEGER NOT NULL DEFAULT 0, seconds TEXT NOT NULL DEFAULT '{}'
);
CREATE INDEX windows_by_interval ON windows (begin_ms, end_ms, kind, version);
CREATE INDEX windows_by_state ON windows (state);
CREATE TABLE window_files (
  window INTEGER NOT NULL REFERENCES windows (id), hash TEXT NOT NULL, role TEXT NOT NULL DEFAULT 'member',
  probe TEXT NOT NULL DEFAULT 'none', PRIMARY KEY (window, hash)
) WITHOUT ROWID;
CREATE INDEX window_files_by_hash ON window_files (hash);
)sql";

template <class Enumeration, std::size_t count>
Enumeration named(const std::array<const char*, count>& names, const std::string& name) {
  for (std::size_t i = 0; i < count; ++i)
    if (name == names[i]) return static_cast<Enumeration>(i);
  throw JournalError("the journal holds \"" + name + "\", which this version does not know");
}

constexpr std::array kFileStates = {"seen", "incomplete", "staged", "published", "quarantined"};
constexpr std::array kWindowStates = {"open", "probing", "published", "empty", "failed"};
constexpr std::array kKinds = {"window", "late", "file"};
constexpr std::array kProbes = {"none", "passed"};

template <class Enumeration, std::size_t count>
const char* name_in(const std::array<const char*, count>& names, Enumeration value) {
  return names[static_cast<std::size_t>(value)];
}

std::string joined(const std::vector<int>& numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

std::vector<int> split(const std::string& text) {
  std::istringstream stream(text);
  std::vector<int> numbers;
  for (int number = 0; stream >> number;) numbers.push_back(number);
  return numbers;
}

#define FILE_COLUMNS                                                                                   \
  "f.hash, f.name, f.size, f.state, f.outcome, f.evidence, f.attempts, f.interruptions, f.deferrals, " \
  "f.not_before_ms, f.seen_ms, f.first_ms, f.last_ms, f.observations, f.platforms, f.staged, f.settled, f.location"

#define SELECT_FILES "SELECT " FILE_COLUMNS " FROM files f "

#define TO_INGEST                                                                                                 \
  "(state = 'seen' OR (staged = 0 AND state IN ('staged', 'published') AND EXISTS (SELECT 1 FROM window_files m " \
  "JOIN windows w ON w.id = m.window WHERE m.hash = f.hash AND m.role = 'member' AND w.state IN ('open', "        \
  "'probing'))))"

FileRecord file_of(const Row& row) {
  FileRecord file;
  file.hash = row.text(0);
  file.name = row.text(1);
  file.size_bytes = row.integer(2);
  file.state = named<FileState>(kFileStates, row.text(3));
  file.outcome = row.text(4);
  file.evidence = row.text(5);
  file.attempts = row.integer(6);
  file.interruptions = row.integer(7);
  file.deferrals = row.integer(8);
  file.not_before_ms = row.integer(9);
  file.seen_ms = row.integer(10);
  file.first_ms = row.optional_integer(11);
  file.last_ms = row.optional_integer(12);
  file.observations = row.integer(13);
  file.platforms = split(row.text(14));
  file.staged = row.integer(15) != 0;
  file.settled = row.integer(16) != 0;
  file.location = row.text(17);
  return file;
}

#define SELECT_WINDOWS                                                                                              \
  "SELECT w.id, w.kind, w.begin_ms, w.end_ms, w.version, w.state, w.output, w.reason, w.attempts, "                 \
  "w.interruptions, w.deferrals, w.not_before_ms, w.last_arrival_ms, w.observations, w.retained, w.seconds, "       \
  "(SELECT count(*) FROM window_files m WHERE m.window = w.id AND m.role = 'member'), "                             \
  "(SELECT count(*) FROM window_files m WHERE m.window = w.id AND m.role = 'dropped'), w.culprits, w.running FROM " \
  "windows w "

WindowRecord window_of(const Row& row) {
  WindowRecord window;
  window.id = row.integer(0);
  window.kind = named<WindowKind>(kKinds, row.text(1));
  window.interval = {row.integer(2), row.integer(3)};
  window.version = static_cast<int>(row.integer(4));
  window.state = named<WindowState>(kWindowStates, row.text(5));
  window.output = row.text(6);
  window.reason = row.text(7);
  window.attempts = row.integer(8);
  window.interruptions = row.integer(9);
  window.deferrals = row.integer(10);
  window.not_before_ms = row.integer(11);
  window.last_arrival_ms = row.integer(12);
  window.observations = row.integer(13);
  window.retained = row.integer(14);
  window.seconds = row.text(15);
  window.files = row.integer(16);
  window.dropped = row.integer(17);
  window.culprits = row.integer(18);
  window.running = row.integer(19) != 0;
  return window;
}

void expect_one(int changed, const std::string& hash, const char* what) {
  if (changed != 1) throw JournalError("the journal has no file " + hash + " that could become " + what);
}

}  // namespace

const char* name_of(FileState state) {
  return name_in(kFileStates, state);
}
const char* name_of(WindowState state) {
  return name_in(kWindowStates, state);
}

Journal::Journal(const std::string& path, Database::Access access) : database_(path, access) {
  if (access == Database::Access::read_write) {
    database_.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON;");
    if (database_.number("PRAGMA user_version") == 0) {
      database_.atomically([&] {
        database_.execute(kSchema);
        database_.execute("PRAGMA user_version = " + std::to_string(kSchemaVersion));
      });
    }
  }
  const std::int64_t version = database_.number("PRAGMA user_version");
  if (version != kSchemaVersion)
    throw JournalError("the journal " + path + " has layout " + std::to_string(version) + ", this program reads " +
                       std::to_string(kSchemaVersion) + ": use the version of thind that wrote it");
}

// Files.

std::optional<FileRecord> Journal::file(const std::string& hash) {
  std::optional<FileRecord> found;
  database_.query(
      SELECT_FILES "WHERE hash = ?", [&](const Row& row) { found = file_of(row); }, hash);
  return found;
}

std::vector<FileRecord> Journal::files(FileState state) {
  std::vector<FileRecord> files;
  database_.query(
      SELECT_FILES "WHERE state = ? ORDER BY seen_ms, name, hash",
      [&](const Row& row) { files.push_back(file_of(row)); }, name_of(state));
  return files;
}

std::vector<FileRecord> Journal::unsettled() {
  std::vector<FileRecord> files;
  database_.query(
      SELECT_FILES
      "WHERE state IN ('published', 'quarantined') AND (settled = 0 OR staged = 1) AND NOT EXISTS (SELECT 1 "
      "FROM window_files m JOIN windows w ON w.id = m.window WHERE m.hash = f.hash AND m.role = 'member' AND "
      "w.state IN ('open', 'probing')) ORDER BY name, hash",
      [&](const Row& row) { files.push_back(file_of(row)); });
  return files;
}

std::vector<FileRecord> Journal::to_ingest(std::int64_t now_ms, std::size_t limit) {
  std::vector<FileRecord> files;
  database_.query(
      SELECT_FILES "WHERE " TO_INGEST " AND running = 0 AND not_before_ms <= ? ORDER BY seen_ms, name, hash LIMIT ?",
      [&](const Row& row) { files.push_back(file_of(row)); }, now_ms, static_cast<std::int64_t>(limit));
  return files;
}

std::optional<std::int64_t> Journal::next_ingest_ms() {
  std::optional<std::int64_t> next;
  database_.query("SELECT min(not_before_ms) FROM files f WHERE " TO_INGEST " AND running = 0",
                  [&](const Row& row) { next = row.optional_integer(0); });
  return next;
}

Journal::IngestCounts Journal::ingest_counts(std::int64_t max_deferrals) {
  IngestCounts counts;
  database_.query(
      "SELECT count(*), coalesce(sum(deferrals < ?), 0) FROM files f WHERE " TO_INGEST,
      [&](const Row& row) {
        counts = {row.integer(0), row.integer(1)};
      },
      max_deferrals);
  return counts;
}

std::optional<std::int64_t> Journal::oldest_undecided_ms() {
  std::optional<std::int64_t> oldest;
  database_.query("SELECT min(seen_ms) FROM files WHERE state IN ('seen', 'incomplete')",
                  [&](const Row& row) { oldest = row.optional_integer(0); });
  return oldest;
}

FileCounts Journal::counts() {
  FileCounts counts;
  database_.query("SELECT state, count(*) FROM files GROUP BY state", [&](const Row& row) {
    const auto state = named<FileState>(kFileStates, row.text(0));
    (state == FileState::published     ? counts.published
     : state == FileState::quarantined ? counts.quarantined
                                       : counts.pending) += row.integer(1);
  });
  counts.seen = count_of("seen");
  counts.duplicates = count_of("duplicates");
  counts.withdrawn = count_of("withdrawn");
  return counts;
}

void Journal::record_seen(const std::string& hash, const std::string& name, std::int64_t size_bytes,
                          std::int64_t now_ms) {
  database_.atomically([&] {
    database_.run("INSERT INTO files (hash, name, size, state, seen_ms) VALUES (?, ?, ?, 'seen', ?)", hash, name,
                  size_bytes, now_ms);
    count("seen", 1);
  });
}

void Journal::record_duplicate() {
  count("duplicates", 1);
}

void Journal::record_retry(const std::string& hash, const std::string& name) {
  expect_one(database_.run("UPDATE files SET state = 'seen', name = ?, outcome = '', evidence = '', attempts = 0, "
                           "interruptions = 0, deferrals = 0, not_before_ms = 0, settled = 0, location = '', "
                           "decided_ms = NULL WHERE hash = ? AND state = 'quarantined'",
                           name, hash),
             hash, "seen again");
}

void Journal::record_incomplete(const std::string& hash, const std::string& reason) {
  expect_one(database_.run("UPDATE files SET state = 'incomplete', outcome = ?, running = 0, attempts = 0 "
                           "WHERE hash = ? AND state = 'seen'",
                           reason, hash),
             hash, "incomplete");
}

void Journal::record_growth(const std::string& old_hash, const std::string& new_hash, std::int64_t size_bytes) {
  expect_one(database_.run("UPDATE files SET hash = ?, size = ?, state = 'seen', outcome = '', interruptions = 0 "
                           "WHERE hash = ? AND state = 'incomplete'",
                           new_hash, size_bytes, old_hash),
             old_hash, "longer");
}

void Journal::record_withdrawal(const std::string& hash) {
  database_.atomically([&] {
    expect_one(database_.run("DELETE FROM files WHERE hash = ? AND state IN ('seen', 'incomplete')", hash), hash,
               "withdrawn");
    count("seen", -1);
    count("withdrawn", 1);
  });
}

void Journal::record_staged(const std::string& hash, const Staged& staged) {
  expect_one(
      database_.run("UPDATE files SET state = CASE state WHEN 'seen' THEN 'staged' ELSE state END, staged = 1, "
                    "running = 0, attempts = 0, interruptions = 0, deferrals = 0, first_ms = ?, last_ms = ?, "
                    "observations = ?, platforms = ? WHERE hash = ? AND state IN ('seen', 'staged', 'published')",
                    staged.first_ms, staged.last_ms, staged.observations, joined(staged.platforms), hash),
      hash, "staged");
}

void Journal::record_unstaged(const std::string& hash) {
  database_.run("UPDATE files SET staged = 0 WHERE hash = ?", hash);
}

void Journal::record_quarantined(const std::string& hash, const std::string& outcome, const std::string& evidence,
                                 std::int64_t now_ms) {
  database_.atomically([&] {
    expect_one(database_.run("UPDATE files SET state = 'quarantined', outcome = ?, evidence = ?, running = 0, "
                             "decided_ms = ? WHERE hash = ? AND state IN ('seen', 'incomplete', 'staged')",
                             outcome, evidence, now_ms, hash),
               hash, "quarantined");
    // It leaves the windows that are still to come; in finished ones it stays as what it was.
    leave_unfinished_windows(hash);
    count("quarantined", 1);
  });
}

void Journal::record_settled(const std::string& hash, const std::string& location) {
  database_.run("UPDATE files SET settled = 1, location = ? WHERE hash = ?", location, hash);
}

void Journal::begin_file_attempt(const std::string& hash) {
  expect_one(database_.run("UPDATE files SET attempts = attempts + 1, running = 1 WHERE hash = ?", hash), hash,
             "tried");
}

void Journal::end_file_attempt(const std::string& hash, std::int64_t not_before_ms) {
  database_.run("UPDATE files SET running = 0, not_before_ms = ? WHERE hash = ?", not_before_ms, hash);
}

void Journal::excuse_file_attempt(const std::string& hash, std::int64_t not_before_ms) {
  database_.run(
      "UPDATE files SET running = 0, attempts = max(attempts - 1, 0), deferrals = deferrals + 1, "
      "not_before_ms = ? WHERE hash = ?",
      not_before_ms, hash);
}

// Windows.

std::vector<WindowRecord> Journal::windows() {
  std::vector<WindowRecord> windows;
  database_.query(SELECT_WINDOWS "ORDER BY begin_ms, end_ms, kind DESC, version, id",
                  [&](const Row& row) { windows.push_back(window_of(row)); });
  return windows;
}

std::vector<WindowRecord> Journal::unfinished_windows() {
  std::vector<WindowRecord> windows;
  database_.query(SELECT_WINDOWS "WHERE state IN ('open', 'probing') ORDER BY begin_ms, id",
                  [&](const Row& row) { windows.push_back(window_of(row)); });
  return windows;
}

std::optional<WindowRecord> Journal::window(std::int64_t id) {
  std::optional<WindowRecord> found;
  database_.query(
      SELECT_WINDOWS "WHERE id = ?", [&](const Row& row) { found = window_of(row); }, id);
  return found;
}

std::optional<WindowRecord> Journal::latest_window(WindowKind kind, const Interval& interval) {
  std::optional<WindowRecord> found;
  database_.query(
      SELECT_WINDOWS "WHERE kind = ? AND begin_ms = ? AND end_ms = ? ORDER BY version DESC LIMIT 1",
      [&](const Row& row) { found = window_of(row); }, name_in(kKinds, kind), interval.begin_ms, interval.end_ms);
  return found;
}

std::int64_t Journal::create_window(WindowKind kind, const Interval& interval, int version, std::int64_t now_ms) {
  database_.run(
      "INSERT INTO windows (kind, begin_ms, end_ms, version, opened_ms, last_arrival_ms) "
      "VALUES (?, ?, ?, ?, ?, ?)",
      name_in(kKinds, kind), interval.begin_ms, interval.end_ms, version, now_ms, now_ms);
  return database_.last_row_id();
}

void Journal::add_member(std::int64_t window, const std::string& hash, std::int64_t now_ms) {
  database_.atomically([&] {
    database_.run("INSERT OR REPLACE INTO window_files (window, hash) VALUES (?, ?)", window, hash);
    database_.run("UPDATE windows SET last_arrival_ms = ? WHERE id = ?", now_ms, window);
  });
}

void Journal::add_dropped(std::int64_t window, const std::string& hash) {
  database_.run("INSERT OR IGNORE INTO window_files (window, hash, role) VALUES (?, ?, 'dropped')", window, hash);
}

bool Journal::all_members_staged(std::int64_t window) {
  return database_.number(
             "SELECT count(*) FROM window_files m JOIN files f ON f.hash = m.hash WHERE m.window = ? AND "
             "m.role = 'member' AND f.staged = 0",
             window) == 0;
}

bool Journal::has_unfinished_before(const WindowRecord& window) {
  return database_.number(
             "SELECT count(*) FROM windows WHERE begin_ms = ? AND end_ms = ? AND kind <> 'file' AND id < ? "
             "AND state IN ('open', 'probing')",
             window.interval.begin_ms, window.interval.end_ms, window.id) > 0;
}

std::vector<Member> Journal::members(std::int64_t window) {
  std::vector<Member> members;
  database_.query(
      "SELECT " FILE_COLUMNS
      ", m.probe FROM window_files m JOIN files f ON f.hash = m.hash "
      "WHERE m.window = ? AND m.role = 'member' ORDER BY f.name, f.hash",
      [&](const Row& row) {
        members.push_back({file_of(row), named<Probe>(kProbes, row.text(18))});
      },
      window);
  return members;
}

bool Journal::is_member_of_unfinished(const std::string& hash) {
  return database_.number(
             "SELECT count(*) FROM window_files m JOIN windows w ON w.id = m.window WHERE m.hash = ? AND "
             "m.role = 'member' AND w.state IN ('open', 'probing')",
             hash) > 0;
}

void Journal::leave_unfinished_windows(const std::string& hash) {
  database_.run(
      "DELETE FROM window_files WHERE hash = ? AND window IN "
      "(SELECT id FROM windows WHERE state IN ('open', 'probing'))",
      hash);
}

void Journal::begin_window_attempt(std::int64_t window) {
  database_.run("UPDATE windows SET attempts = attempts + 1, running = 1 WHERE id = ?", window);
}

void Journal::end_window_attempt(std::int64_t window, const std::string& reason, std::int64_t not_before_ms) {
  database_.run("UPDATE windows SET running = 0, reason = ?, not_before_ms = ? WHERE id = ?", reason, not_before_ms,
                window);
}

void Journal::excuse_window_attempt(std::int64_t window, std::int64_t not_before_ms) {
  database_.run(
      "UPDATE windows SET running = 0, attempts = max(attempts - 1, 0), deferrals = deferrals + 1, "
      "not_before_ms = ? WHERE id = ?",
      not_before_ms, window);
}

void Journal::begin_probing(std::int64_t window) {
  database_.atomically([&] {
    database_.run(
        "UPDATE windows SET state = 'probing', running = 0, attempts = 0, interruptions = 0, culprits = 0 "
        "WHERE id = ?",
        window);
    database_.run("UPDATE window_files SET probe = 'none' WHERE window = ?", window);
  });
}

void Journal::record_probe_passed(std::int64_t window, const std::string& hash) {
  database_.atomically([&] {
    database_.run("UPDATE window_files SET probe = 'passed' WHERE window = ? AND hash = ?", window, hash);
    database_.run("UPDATE windows SET running = 0, attempts = 0, interruptions = 0 WHERE id = ?", window);
  });
}

void Journal::record_culprit(std::int64_t window, const std::string& hash) {
  database_.atomically([&] {
    database_.run("DELETE FROM window_files WHERE window = ? AND hash = ?", window, hash);
    database_.run(
        "UPDATE windows SET running = 0, attempts = 0, interruptions = 0, culprits = culprits + 1 "
        "WHERE id = ?",
        window);
  });
}

void Journal::end_probing(std::int64_t window) {
  database_.run("UPDATE windows SET state = 'open', attempts = 0, interruptions = 0, running = 0 WHERE id = ?", window);
}

void Journal::record_outcome(std::int64_t window, const WindowOutcome& outcome, std::int64_t now_ms) {
  database_.atomically([&] {
    const std::vector<Member> concerned = members(window);
    database_.run(
        "UPDATE windows SET state = ?, version = ?, output = ?, reason = ?, observations = ?, retained = ?, seconds = "
        "?, "
        "running = 0, attempts = 0, deferrals = 0, closed_ms = ? WHERE id = ?",
        name_of(outcome.state), outcome.version, outcome.output, outcome.reason, outcome.observations, outcome.retained,
        outcome.seconds, now_ms, window);
    for (const Member& member : concerned) publish_if_done(member.file.hash, now_ms);
  });
}

void Journal::publish_if_done(const std::string& hash, std::int64_t now_ms) {
  if (is_member_of_unfinished(hash)) return;
  std::string outputs, empty;
  database_.query(
      "SELECT w.output, w.reason FROM window_files m JOIN windows w ON w.id = m.window WHERE m.hash = ? AND "
      "m.role = 'member' AND w.state IN ('published', 'empty') ORDER BY w.begin_ms, w.id",
      [&](const Row& row) {
        const std::string output = row.text(0);
        std::string& list = output.empty() ? empty : outputs;
        list += (list.empty() ? "" : ", ") + (output.empty() ? row.text(1) : output);
      },
      hash);
  const std::string outcome = !outputs.empty() ? "in " + outputs
                              : !empty.empty() ? "nothing retained: " + empty
                                               : std::string(kLateOutcome);
  database_.run("UPDATE files SET state = 'published', outcome = ?, decided_ms = ? WHERE hash = ? AND state = 'staged'",
                outcome, now_ms, hash);
}

void Journal::count_interruptions() {
  database_.atomically([&] {
    for (const std::string table : {"files", "windows"}) {
      database_.execute("UPDATE " + table +
                        " SET running = 0, attempts = max(attempts - 1, 0), interruptions = "
                        "interruptions + 1 WHERE running = 1");
      database_.execute("UPDATE " + table + " SET deferrals = 0, not_before_ms = 0 WHERE not_before_ms > 0");
    }
  });
}

std::string Journal::fact(const std::string& name) {
  std::string value;
  database_.query(
      "SELECT value FROM facts WHERE name = ?", [&](const Row& row) { value = row.text(0); }, name);
  return value;
}

void Journal::set_fact(const std::string& name, const std::string& value) {
  database_.run("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", name, value);
}

std::int64_t Journal::count_of(const std::string& counter) {
  return database_.number("SELECT CAST(value AS INTEGER) FROM facts WHERE name = ?", "count " + counter);
}

void Journal::count(const std::string& counter, std::int64_t change) {
  set_fact("count " + counter, std::to_string(count_of(counter) + change));
}

}  // namespace thind
