#include "daemon/folders.h"

namespace thind {

Folders::Folders(const DaemonSettings& settings)
    : inbox(settings.inbox),
      outbox(settings.outbox),
      archive(settings.archive),
      quarantine(settings.quarantine),
      late(settings.late),
      state(settings.state),
      spool(state + "/spool"),
      staged(state + "/staged"),
      work(state + "/work"),
      config(state + "/config"),
      reports(outbox + "/reports") {}

thin::Result<void> Folders::make() const {
  for (const std::string& folder : {inbox, outbox, archive, quarantine, late, state, spool, staged, work, config}) {
    if (auto made = make_folder(folder); !made) return made;
  }
  return {};
}

thin::Result<void> Folders::remove_unfinished() const {
  if (auto removed = remove_tree(work); !removed) return removed;
  if (auto made = make_folder(work); !made) return made;
  for (const std::string& folder : {inbox, outbox, reports, archive, quarantine, late, spool, staged, config}) {
    if (!exists(folder)) continue;
    auto names = list_folder(folder);
    if (!names) return names.error();
    for (const std::string& name : *names) {
      if (!name.starts_with(kUnfinishedPrefix)) continue;
      // In the inbox a sender may use such names too; ours are there only while a file is given back.
      if (folder == inbox && name.size() != 5 + 32) continue;
      if (auto removed = remove_tree(path_in(folder, name)); !removed) return removed;
    }
  }
  return {};
}

}  // namespace thind
