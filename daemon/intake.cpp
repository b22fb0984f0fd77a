#include "daemon/intake.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/quarantine.h"

namespace thind {
namespace {

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
}

FileStamp stamp_of(const struct stat& facts) {
  return {facts.st_dev, facts.st_ino, facts.st_size, nanoseconds(facts.st_mtim), nanoseconds(facts.st_ctim)};
}

std::chrono::milliseconds settle_time(const Settings& settings) {
  return std::chrono::milliseconds(milliseconds(settings.daemon.settle_seconds));
}

bool is_ignored(const std::string& name, const DaemonSettings& settings) {
  return name.starts_with('.') ||
         std::any_of(settings.ignore_suffixes.begin(), settings.ignore_suffixes.end(),
                     [&](const std::string& suffix) { return !suffix.empty() && name.ends_with(suffix); });
}

}  // namespace

Intake::Intake(const Settings& settings, const Folders& folders, Journal& journal)
    : settings_(settings),
      folders_(folders),
      journal_(journal),
      watcher_(folders.inbox, settings.daemon.poll_only),
      completeness_(settle_time(settings)),
      next_rescan_(std::chrono::steady_clock::now()) {
  if (!watcher_.problem().empty()) log(Level::warning, watcher_.problem() + "; relying on rescans");
}

void Intake::take_settings() {
  completeness_.set_settle(settle_time(settings_));
  next_rescan_ = std::chrono::steady_clock::now();
}

std::optional<MonotonicTime> Intake::next_due() const {
  const auto next = completeness_.next_due();
  return next ? std::min(*next, next_rescan_) : next_rescan_;
}

std::optional<std::int64_t> Intake::oldest_undecided_ms() {
  const auto in_inbox = completeness_.oldest_undecided_ms(), journaled = journal_.oldest_undecided_ms();
  return in_inbox && journaled ? std::min(*in_inbox, *journaled) : in_inbox ? in_inbox : journaled;
}

Result<void> Intake::step(MonotonicTime now) {
  Watcher::Events events = watcher_.take();
  for (const std::string& name : events.names) look_at(name, now);
  if (events.rescan || now >= next_rescan_) {
    if (auto scanned = rescan(now); !scanned) return scanned;
  }
  for (const std::string& name : completeness_.due(now)) {
    const FileStamp before = *completeness_.stamp(name);
    look_at(name, now);
    const FileStamp* after = completeness_.stamp(name);
    if (!after || !(before == *after)) continue;
    if (auto taken = take(name); !taken) return taken;
  }
  return {};
}

Result<void> Intake::rescan(MonotonicTime now) {
  watcher_.renew();
  next_rescan_ = now + std::chrono::milliseconds(milliseconds(settings_.daemon.rescan_seconds));
  auto names = list_folder(folders_.inbox);
  if (!names) return names.error();
  const std::set<std::string> there(names->begin(), names->end());
  for (const std::string& name : completeness_.names())
    if (!there.contains(name)) completeness_.forget(name);
  std::erase_if(left_, [&](const std::string& name) { return !there.contains(name); });
  for (const std::string& name : *names) look_at(name, now);
  scanned_ = true;
  if (auto expired = expire_empty(); !expired) return expired;
  if (auto expired = expire_incomplete(); !expired) return expired;
  notice_withdrawals();
  return {};
}

void Intake::look_at(const std::string& name, MonotonicTime now) {
  if (is_ignored(name, settings_.daemon)) return;
  struct stat facts {};
  if (::lstat((folders_.inbox + "/" + name).c_str(), &facts) != 0) return completeness_.forget(name);
  if (!S_ISREG(facts.st_mode)) {
    completeness_.forget(name);
    return leave(name, "is no regular file");
  }
  // It may lie there since before the daemon started, and counts from then.
  const std::int64_t noticed_ms = std::min(wall_clock_ms(), nanoseconds(facts.st_ctim) / 1'000'000);
  completeness_.observe(name, stamp_of(facts), now, noticed_ms);
}

void Intake::leave(const std::string& name, const std::string& why) {
  if (left_.insert(name).second) log(Level::warning, name + " stays in the inbox: it " + why, {{"file", name}});
}

Result<void> Intake::take(const std::string& name) {
  const std::string path = folders_.inbox + "/" + name;
  const FileStamp stamp = *completeness_.stamp(name);
  // An empty file may be a name that its sender has reserved; expire_empty() sees to it with every rescan.
  if (stamp.size_bytes == 0) return completeness_.set_waiting(name, false), Result<void>();
  // Never blocks: neither on a FIFO that took the file's place meanwhile, nor by following a link.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!file) {
    if (thin::kind_of_errno(errno) == ErrorKind::temporary) return thin::system_error("open", path, errno);
    leave(name, std::string("can't be read: ") + std::strerror(errno));
    completeness_.set_waiting(name, true);
    return {};
  }
  struct stat facts {};
  if (::fstat(file.get(), &facts) != 0 || !S_ISREG(facts.st_mode) || !(stamp_of(facts) == stamp)) return {};
  auto hash = sha256_of_descriptor(file.get());
  if (!hash) return hash.error();
  // What is journaled must be on the disk before the sender's copy is the only one.
  if (::fsync(file.get()) != 0) return thin::system_error("sync", path, errno);
  if (::lstat(path.c_str(), &facts) != 0 || !(stamp_of(facts) == stamp)) return {};
  return take_content(name, *hash, stamp);
}

Result<void> Intake::take_content(const std::string& name, const std::string& hash, const FileStamp& stamp) {
  const std::int64_t noticed_ms = *completeness_.noticed_ms(name);
  const auto known = journal_.file(hash);
  const auto beginning = beginning_of(name);
  if (known && beginning && beginning->hash != hash) {
    // It has grown into something that came before by another way.
    journal_.record_withdrawal(beginning->hash);
    if (auto removed = remove_file(folders_.spooled(beginning->hash)); !removed) return removed;
  }
  if (!known) {
    if (beginning) {
      journal_.record_growth(beginning->hash, hash, stamp.size_bytes);
      if (auto removed = remove_file(folders_.spooled(beginning->hash)); !removed) return removed;
      log(Level::information, fmt::format("{} has grown to {} bytes", name, stamp.size_bytes), {{"file", name}});
    } else {
      journal_.record_seen(hash, name, stamp.size_bytes, noticed_ms);
      log(Level::debug, fmt::format("{} seen, {} bytes", name, stamp.size_bytes), {{"file", name}, {"sha256", hash}});
    }
    return spool(name, hash);
  }
  switch (known->state) {
    case FileState::incomplete:
      return completeness_.set_waiting(name, true), Result<void>();
    case FileState::quarantined:
      return retry_quarantined(*known, name);
    case FileState::seen:
      // Journaled, but not moved: the daemon died in between.
      if (!exists(folders_.spooled(hash))) return spool(name, hash);
      [[fallthrough]];
    default:
      return take_duplicate(name, hash);
  }
}

Result<void> Intake::spool(const std::string& name, const std::string& hash) {
  const std::string from = folders_.inbox + "/" + name, to = folders_.spooled(hash);
  auto moved = move_to_free(from, to);
  if (!moved) return moved.error();
  completeness_.forget(name);
  auto arrived = sha256_of_file(to);
  if (!arrived) return arrived.error();
  if (*arrived == hash) return {};
  // The sender has put something else in its place at the last moment. That is new, and not yet seen.
  log(Level::warning, name + " changed while it was taken; it is looked at again", {{"file", name}});
  auto returned = move_to_free(to, from);
  if (!returned) return returned.error();
  journal_.record_withdrawal(hash);
  return {};
}

Result<void> Intake::take_duplicate(const std::string& name, const std::string& hash) {
  auto placed = place_file(folders_.inbox + "/" + name, folders_.archive, name, hash);
  if (!placed) return placed.error();
  completeness_.forget(name);
  journal_.record_duplicate();
  log(Level::information, name + " duplicate: the same content came before; archived",
      {{"file", name}, {"outcome", "duplicate"}, {"sha256", hash}});
  return {};
}

Result<void> Intake::retry_quarantined(const FileRecord& file, const std::string& name) {
  journal_.record_retry(file.hash, name);
  log(Level::information, name + " comes again after its quarantine and is tried again", {{"file", name}});
  if (auto spooled = spool(name, file.hash); !spooled) return spooled;
  // Only with the bytes in the spool may the old copy go.
  if (file.location.empty() || !exists(folders_.spooled(file.hash))) return {};
  for (const std::string& old : {file.location, reason_path(file.location)})
    if (auto removed = remove_file(old); !removed) return removed;
  return {};
}

Result<void> Intake::expire_empty() {
  const std::int64_t noticed_before_ms = wall_clock_ms() - milliseconds(settings_.daemon.max_wait_seconds);
  for (const std::string& name : completeness_.names()) {
    if (completeness_.stamp(name)->size_bytes > 0 || *completeness_.noticed_ms(name) > noticed_before_ms) continue;
    if (auto taken = take_empty(name); !taken) return taken;
  }
  return {};
}

Result<void> Intake::take_empty(const std::string& name) {
  const std::int64_t now_ms = wall_clock_ms();
  const std::string hash = sha256_of("");
  const auto known = journal_.file(hash);
  if (known && known->state != FileState::quarantined) return spool(name, hash);
  journal_.atomically([&] {
    if (known)
      journal_.record_retry(hash, name);
    else
      journal_.record_seen(hash, name, 0, now_ms);
  });
  if (auto spooled = spool(name, hash); !spooled) return spooled;
  quarantine_file(journal_, *journal_.file(hash), "is empty, and stayed so for longer than daemon.max_wait_seconds",
                  nullptr);
  return {};
}

}  // namespace thind
