#pragma once

// The operating system's word that something has happened in a folder. It may be late, doubled or lost: it only says
// where to look sooner than the next rescan would.

#include <string>
#include <vector>

#include "daemon/descriptor.h"

namespace thind {

class Watcher {
 public:
  // Watches for files that were closed after writing or moved in. With poll_only (network file systems), or where the
  // kernel refuses, it never reports anything: problem() then says why, and rescans must do.
  Watcher(std::string folder, bool poll_only);

  // Readable when there is something to take; -1 where nothing is watched.
  int descriptor() const { return inotify_.get(); }
  const std::string& problem() const { return problem_; }

  struct Events {
    std::vector<std::string> names;  // of files to look at
    bool rescan = false;             // events were lost, or the folder itself was replaced
  };

  // What has happened since the last call; never blocks.
  Events take();

  // Tries again where watching has failed: to be called with every rescan.
  void renew();

 private:
  void watch();

  std::string folder_;
  bool poll_only_;
  Descriptor inotify_;
  std::string problem_;
};

}  // namespace thind
