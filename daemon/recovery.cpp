#include "daemon/recovery.h"

#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/quarantine.h"
#include "libthin/foundation/version.h"

namespace thind {
namespace {

Result<void> adopt_unknown(const Folders& folders, Journal& journal) {
  auto names = list_folder(folders.spool);
  if (!names) return names.error();
  for (const std::string& name : *names) {
    if (journal.file(name)) continue;
    const std::string path = folders.spool + "/" + name;
    auto hash = sha256_of_file(path);
    if (!hash) return hash.error();
    if (*hash != name) {
      auto moved = move_to_free(path, folders.spooled(*hash));
      if (!moved) return moved.error();
      if (journal.file(*hash)) continue;
    }
    log(Level::warning,
        "the spool holds content that the journal does not know; it is taken up as recovered-" + hash->substr(0, 8));
    auto text = read_file(folders.spooled(*hash));
    if (!text) return text.error();
    journal.record_seen(*hash, "recovered-" + hash->substr(0, 8), static_cast<std::int64_t>(text->size()),
                        wall_clock_ms());
  }
  return {};
}

// staged/ holds exactly what the journal says, and by this version.
Result<void> agree_on_staged(const Folders& folders, Journal& journal) {
  const bool other_version = journal.fact("version") != thin::kVersion;
  for (const FileState state : {FileState::staged, FileState::published, FileState::quarantined})
    for (const FileRecord& file : journal.files(state))
      if (file.staged && (other_version || !exists(folders.staged_file(file.hash)))) journal.record_unstaged(file.hash);
  auto names = list_folder(folders.staged);
  if (!names) return names.error();
  for (const std::string& name : *names) {
    const auto file = journal.file(name.substr(0, name.rfind('.')));
    if (file && file->staged) continue;
    if (auto removed = remove_file(folders.staged + "/" + name); !removed) return removed;
  }
  if (other_version) journal.set_fact("version", thin::kVersion);
  return {};
}

void mourn_vanished(const Folders& folders, Journal& journal) {
  for (const FileRecord& file : journal.files(FileState::staged))
    if (!exists(folders.spooled(file.hash)))
      quarantine_file(journal, file, "has vanished from the spool by someone else's hand", nullptr);
}

}  // namespace

Result<void> recover(const Folders& folders, Journal& journal) {
  if (auto removed = folders.remove_unfinished(); !removed) return removed;
  journal.count_interruptions();
  if (auto adopted = adopt_unknown(folders, journal); !adopted) return adopted;
  if (auto agreed = agree_on_staged(folders, journal); !agreed) return agreed;
  mourn_vanished(folders, journal);
  return {};
}

}  // namespace thind
