#pragma once

// Which files of a folder have come to rest: the same file, size and times for the settling time, as far as looking can
// tell. What they hold decides later whether they are complete.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace thind {

// What changes when a file changes.
struct FileStamp {
  std::uint64_t device = 0, inode = 0;
  std::int64_t size_bytes = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

class Completeness {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Completeness(std::chrono::milliseconds settle) : settle_(settle) {}
  void set_settle(std::chrono::milliseconds settle) { settle_ = settle; }

  // `name` looks like this now. noticed_ms: wall clock, remembered from the first time.
  void observe(const std::string& name, const FileStamp& stamp, Time now, std::int64_t noticed_ms);
  void forget(const std::string& name) { candidates_.erase(name); }
  // Nothing can be done about it until it changes; it is not due until then.
  void set_waiting(const std::string& name, bool decided);

  // Those that look as they did settle ago, and are not waiting: to be looked at once more, and taken.
  std::vector<std::string> due(Time now) const;
  std::optional<Time> next_due() const;

  bool knows(const std::string& name) const { return candidates_.contains(name); }
  std::vector<std::string> names() const;
  std::optional<std::int64_t> noticed_ms(const std::string& name) const;
  const FileStamp* stamp(const std::string& name) const;

  // When the first of those that are neither taken nor decided was noticed.
  std::optional<std::int64_t> oldest_undecided_ms() const;
  bool all_waiting() const;

 private:
  struct Candidate {
    FileStamp stamp;
    Time since;
    std::int64_t noticed_ms = 0;
    bool waiting = false;
    bool decided = false;  // waiting, and no window need wait for it
  };
  std::chrono::milliseconds settle_;
  std::map<std::string, Candidate> candidates_;
};

}  // namespace thind
