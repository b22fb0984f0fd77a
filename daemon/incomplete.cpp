// The part of the intake that deals with files whose end has not come yet.

#include <fmt/format.h>
#include <sys/stat.h>

#include "daemon/clock.h"
#include "daemon/intake.h"
#include "daemon/log.h"
#include "daemon/quarantine.h"

namespace thind {
namespace {

// When the entry last changed in any way; nothing where it is absent.
std::optional<std::int64_t> changed_ms(const std::string& path) {
  struct stat facts {};
  if (::lstat(path.c_str(), &facts) != 0) return std::nullopt;
  return facts.st_ctim.tv_sec * std::int64_t{1000} + facts.st_ctim.tv_nsec / 1'000'000;
}

}  // namespace

Result<void> Intake::give_back(const FileRecord& file) {
  const std::string from = folders_.spooled(file.hash);
  if (!exists(from)) return {};
  // Where the sender has a new file of that name already, the cut one stays in the spool until its time is over.
  auto moved = move_to_free(from, folders_.inbox + "/" + file.name);
  if (!moved) return moved.error();
  return {};
}

std::optional<FileRecord> Intake::beginning_of(const std::string& name) {
  for (const FileRecord& file : journal_.files(FileState::incomplete)) {
    if (file.name != name) continue;
    const auto beginning = sha256_of_beginning(folders_.inbox + "/" + name, file.size_bytes);
    if (beginning && *beginning == file.hash) return file;
  }
  return std::nullopt;
}

Result<void> Intake::expire_incomplete() {
  for (const FileRecord& file : journal_.files(FileState::incomplete)) {
    const std::string in_inbox = folders_.inbox + "/" + file.name, in_spool = folders_.spooled(file.hash);
    // It may still be on its way back, or have found its name taken.
    if (auto returned = give_back(file); !returned) return returned;
    const auto changed = changed_ms(exists(in_spool) ? in_spool : in_inbox);
    const std::int64_t waited_ms = wall_clock_ms() - std::max(file.seen_ms, changed.value_or(0));
    if (!changed || waited_ms < milliseconds(settings_.daemon.max_wait_seconds)) continue;
    if (!exists(in_spool)) {
      const auto hash = sha256_of_file(in_inbox);
      if (!hash || *hash != file.hash) continue;  // it has changed: taken as soon as it rests
      auto moved = move_to_free(in_inbox, in_spool);
      if (!moved) return moved.error();
      completeness_.forget(file.name);
    }
    quarantine_file(journal_, file,
                    fmt::format("stayed incomplete for longer than daemon.max_wait_seconds ({:.0f} s): {}",
                                settings_.daemon.max_wait_seconds, file.outcome),
                    nullptr);
  }
  return {};
}

// What was journaled and is nowhere was taken back, or overwritten, by its sender: it never became ours. A file that
// has its name is either what it has grown into, or will be seen as what it is.
void Intake::notice_withdrawals() {
  for (const FileState state : {FileState::seen, FileState::incomplete})
    for (const FileRecord& file : journal_.files(state)) {
      if (exists(folders_.spooled(file.hash)) || exists(folders_.inbox + "/" + file.name)) continue;
      log(Level::warning, file.name + " was withdrawn by its sender before it was complete", {{"file", file.name}});
      journal_.record_withdrawal(file.hash);
    }
}

}  // namespace thind
