#pragma once

// SQLite in the few calls that the journal needs: statements with arguments, rows, transactions.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace thind {

// The journal could not be read or written (disk full, I/O error), or holds what it must not. Whoever catches it knows
// nothing about what was recorded, so it goes on as after a crash: wait, recover, repeat.
class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Row {
 public:
  explicit Row(sqlite3_stmt* statement) : statement_(statement) {}
  std::int64_t integer(int column) const;
  std::optional<std::int64_t> optional_integer(int column) const;
  std::string text(int column) const;

 private:
  sqlite3_stmt* statement_;
};

class Database {
 public:
  enum class Access { read_only, read_write };

  // Throws JournalError, as all below.
  Database(const std::string& path, Access access);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  // Several statements without arguments.
  void execute(const std::string& script);

  // One statement; ? are bound to the arguments in order (integers, texts, optionals, bools). Returns the number of
  // rows changed.
  template <class... Arguments>
  int run(const char* sql, const Arguments&... arguments) {
    return query(
        sql, [](const Row&) {}, arguments...);
  }

  template <class... Arguments>
  int query(const char* sql, const std::function<void(const Row&)>& each_row, const Arguments&... arguments) {
    sqlite3_stmt* statement = prepared(sql);
    int place = 0;
    (bind(statement, ++place, arguments), ...);
    return step_through(statement, each_row);
  }

  // The single integer that the statement yields; 0 where it yields none.
  template <class... Arguments>
  std::int64_t number(const char* sql, const Arguments&... arguments) {
    std::int64_t value = 0;
    query(
        sql, [&](const Row& row) { value = row.integer(0); }, arguments...);
    return value;
  }

  // All of `steps` or nothing; calls may be nested, the outermost commits.
  void atomically(const std::function<void()>& steps);

  // Reads only, all of one moment.
  void atomically_reading(const std::function<void()>& steps);

  std::int64_t last_row_id() const;
  // Rows changed since it was opened.
  std::int64_t changes() const;

 private:
  sqlite3_stmt* prepared(const char* sql);
  void bind(sqlite3_stmt* statement, int place, std::int64_t value);
  void bind(sqlite3_stmt* statement, int place, int value) { bind(statement, place, std::int64_t{value}); }
  void bind(sqlite3_stmt* statement, int place, bool value) { bind(statement, place, std::int64_t{value}); }
  void bind(sqlite3_stmt* statement, int place, const std::string& value);
  void bind(sqlite3_stmt* statement, int place, const char* value) { bind(statement, place, std::string(value)); }
  void bind_nothing(sqlite3_stmt* statement, int place);
  template <class T>
  void bind(sqlite3_stmt* statement, int place, const std::optional<T>& value) {
    if (value)
      bind(statement, place, *value);
    else
      bind_nothing(statement, place);
  }
  int step_through(sqlite3_stmt* statement, const std::function<void(const Row&)>& each_row);
  [[noreturn]] void fail(const std::string& what) const;

  sqlite3* connection_ = nullptr;
  std::string path_;
  std::map<std::string, sqlite3_stmt*> statements_;
  void in_transaction(const char* begin, const std::function<void()>& steps);

  int depth_ = 0;
};

}  // namespace thind
