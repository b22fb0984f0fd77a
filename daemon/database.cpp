#include "daemon/database.h"

#include <sqlite3.h>

namespace thind {

std::int64_t Row::integer(int column) const {
  return sqlite3_column_int64(statement_, column);
}

std::optional<std::int64_t> Row::optional_integer(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
  return integer(column);
}

std::string Row::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))) : std::string();
}

Database::Database(const std::string& path, Access access) : path_(path) {
  const int flags = access == Access::read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (sqlite3_open_v2(path.c_str(), &connection_, flags, nullptr) != SQLITE_OK) {
    const std::string why = connection_ ? sqlite3_errmsg(connection_) : "out of memory";
    sqlite3_close(connection_);
    throw JournalError("cannot open the journal " + path + ": " + why);
  }
  sqlite3_extended_result_codes(connection_, 1);
  sqlite3_busy_timeout(connection_, 5000);
}

Database::~Database() {
  for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
  sqlite3_close(connection_);
}

void Database::fail(const std::string& what) const {
  throw JournalError("journal " + path_ + ": cannot " + what + ": " + sqlite3_errmsg(connection_));
}

void Database::execute(const std::string& script) {
  if (sqlite3_exec(connection_, script.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail("run: " + script);
}

sqlite3_stmt* Database::prepared(const char* sql) {
  sqlite3_stmt*& statement = statements_[sql];
  if (!statement && sqlite3_prepare_v2(connection_, sql, -1, &statement, nullptr) != SQLITE_OK)
    fail(std::string("prepare: ") + sql);
  return statement;
}

void Database::bind(sqlite3_stmt* statement, int place, std::int64_t value) {
  if (sqlite3_bind_int64(statement, place, value) != SQLITE_OK) fail("bind a number");
}

void Database::bind(sqlite3_stmt* statement, int place, const std::string& value) {
  const int bytes = static_cast<int>(value.size());
  if (sqlite3_bind_text(statement, place, value.data(), bytes, SQLITE_TRANSIENT) != SQLITE_OK) fail("bind a text");
}

void Database::bind_nothing(sqlite3_stmt* statement, int place) {
  if (sqlite3_bind_null(statement, place) != SQLITE_OK) fail("bind nothing");
}

int Database::step_through(sqlite3_stmt* statement, const std::function<void(const Row&)>& each_row) {
  // A statement that is left half way would hold its read lock; it is reset however this ends.
  struct Reset {
    sqlite3_stmt* statement;
    ~Reset() {
      sqlite3_reset(statement);
      sqlite3_clear_bindings(statement);
    }
  } reset{statement};
  int result = 0;
  while ((result = sqlite3_step(statement)) == SQLITE_ROW) each_row(Row(statement));
  if (result != SQLITE_DONE) fail(std::string("run: ") + sqlite3_sql(statement));
  return sqlite3_changes(connection_);
}

void Database::atomically(const std::function<void()>& steps) {
  in_transaction("BEGIN IMMEDIATE", steps);
}

void Database::atomically_reading(const std::function<void()>& steps) {
  in_transaction("BEGIN", steps);
}

void Database::in_transaction(const char* begin, const std::function<void()>& steps) {
  if (depth_ > 0) return steps();
  execute(begin);
  ++depth_;
  try {
    steps();
    execute("COMMIT");
  } catch (...) {
    // After some errors (disk full) SQLite has rolled back by itself; then this fails, and nothing is amiss.
    sqlite3_exec(connection_, "ROLLBACK", nullptr, nullptr, nullptr);
    --depth_;
    throw;
  }
  --depth_;
}

std::int64_t Database::changes() const {
  return sqlite3_total_changes64(connection_);
}

std::int64_t Database::last_row_id() const {
  return sqlite3_last_insert_rowid(connection_);
}

}  // namespace thind
