#pragma once

// Where things lie. Inside the state folder:
//   journal.sqlite   spool/HASH (originals)   staged/HASH.nc (decoded)   work/ (of running workers)   config/

#include <string>

#include "daemon/file_system.h"
#include "daemon/journal.h"
#include "daemon/settings.h"

namespace thind {

// Names that begin so are ours and unfinished, in whatever folder.
inline constexpr const char* kUnfinishedPrefix = ".tmp-";

struct Folders {
  explicit Folders(const DaemonSettings& settings);

  std::string journal() const { return state + "/journal.sqlite"; }
  std::string spooled(const std::string& hash) const { return spool + "/" + hash; }
  std::string staged_file(const std::string& hash) const { return staged + "/" + hash + ".nc"; }
  // The original of a file, wherever its state has brought it.
  std::string original(const FileRecord& file) const { return file.settled ? file.location : spooled(file.hash); }

  // Makes those that are missing.
  thin::Result<void> make() const;
  // Removes what a daemon that died has left half done. REQUIRES: no worker runs
  thin::Result<void> remove_unfinished() const;

  std::string inbox, outbox, archive, quarantine, late, state, spool, staged, work, config, reports;
};

}  // namespace thind
