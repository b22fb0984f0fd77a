#pragma once

// From the inbox into the journal and the spool: sees files, waits until they rest, identifies them by content, takes
// them. Incomplete ones go back under their name, so that a sender who appends to them or sends them again finds them.

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "daemon/clock.h"
#include "daemon/completeness.h"
#include "daemon/folders.h"
#include "daemon/journal.h"
#include "daemon/settings.h"
#include "daemon/watcher.h"

namespace thind {

class Intake {
 public:
  Intake(const Settings& settings, const Folders& folders, Journal& journal);

  // Readable when events wait; -1 where there is nothing but rescans.
  int descriptor() const { return watcher_.descriptor(); }
  std::optional<MonotonicTime> next_due() const;

  // Takes in whatever is due: events, a rescan where it is time, files that have come to rest, incomplete files whose
  // time is over. Errors are the machine's making, and the call is to be repeated.
  Result<void> step(MonotonicTime now);

  // When the first file was noticed that is in the inbox and not yet decided; those that are known to be incomplete
  // count as well, until their time is over.
  std::optional<std::int64_t> oldest_undecided_ms();

  // Nothing left to take, but what waits for its sender.
  bool drained() const { return scanned_ && completeness_.all_waiting(); }
  // The first look at the inbox is done: what lay there at the start is known.
  bool scanned() const { return scanned_; }

  // The file went to the worker and has no end: back into the inbox with it, if its name is free there.
  Result<void> give_back(const FileRecord& file);

  // After SIGHUP.
  void take_settings();

 private:
  Result<void> rescan(MonotonicTime now);
  void look_at(const std::string& name, MonotonicTime now);
  Result<void> take(const std::string& name);
  Result<void> take_content(const std::string& name, const std::string& hash, const FileStamp& stamp);
  Result<void> spool(const std::string& name, const std::string& hash);
  Result<void> take_duplicate(const std::string& name, const std::string& hash);
  Result<void> take_empty(const std::string& name);
  Result<void> expire_empty();
  Result<void> retry_quarantined(const FileRecord& file, const std::string& name);
  // The incomplete file that has grown into this one.
  std::optional<FileRecord> beginning_of(const std::string& name);
  Result<void> expire_incomplete();
  void notice_withdrawals();
  void leave(const std::string& name, const std::string& why);

  const Settings& settings_;
  const Folders& folders_;
  Journal& journal_;
  Watcher watcher_;
  Completeness completeness_;
  std::set<std::string> left_;  // entries that are no files or can't be read, and have been spoken of
  MonotonicTime next_rescan_;
  bool scanned_ = false;
};

}  // namespace thind
