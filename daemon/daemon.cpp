#include "daemon/daemon.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>

#include <algorithm>
#include <cerrno>

#include "daemon/archive.h"
#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/recovery.h"
#include "libthin/foundation/version.h"

namespace thind {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kCheckSeconds = 60;

sigset_t handled_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&signals, signal);
  return signals;
}

}  // namespace

Result<void> check_with_worker(const Settings& settings) {
  WorkerCommand command;
  command.arguments = {settings.daemon.worker, "check", "--config", settings.path};
  command.limits.wall_seconds = kCheckSeconds;
  auto exit = run_worker(command);
  if (!exit) return exit.error();
  if (exit->exit_code == 0) return {};
  std::string said = exit->last_errors;
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (exit->exit_code == 2 && !said.empty()) return Error{ErrorKind::configuration, said};
  return Error{ErrorKind::temporary,
               settings.daemon.worker + " check " + describe(*exit) + (said.empty() ? "" : ": " + said)};
}

Daemon::Daemon(Settings settings, bool once)
    : settings_(std::move(settings)), once_(once), folders_(settings_.daemon) {}

Result<int> Daemon::run() {
  if (auto ready = set_up(); !ready) return ready.error();
  notification_.ready("watching " + folders_.inbox);
  while (!is_over()) {
    wait();
    notification_.alive();
    take_signals();
    turn();
  }
  log(Level::information, stop_deadline_ ? "thind stopped" : "thind has done all there was");
  return exit_status();
}

Result<void> Daemon::set_up() {
  if (auto made = folders_.make(); !made) return made;
  for (const auto& [lock, path] :
       {std::pair(&state_lock_, folders_.state + "/lock"), std::pair(&inbox_lock_, folders_.inbox + "/.thind.lock")}) {
    auto taken = Lock::take(path);
    if (!taken) return taken.error();
    *lock = std::move(*taken);
  }
  const sigset_t signals = handled_signals();
  ::sigprocmask(SIG_BLOCK, &signals, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  signals_ = Descriptor(::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK));
  if (!signals_) return thin::system_error("make", "a signal descriptor", errno);
  log(Level::information, fmt::format("thind {} watches {}", thin::kVersion, folders_.inbox));
  try {
    if (auto begun = begin_work(); !begun) return begun;
    quarantined_before_ = work_->journal.quarantined_ever();
  } catch (const JournalError& error) {
    return Error{ErrorKind::temporary, error.what()};
  }
  return {};
}

Result<void> Daemon::begin_work() {
  work_.reset();  // ends its workers first
  work_ = std::make_unique<Work>(settings_, folders_);
  auto recovered = recover(folders_, work_->journal);
  if (!recovered) work_.reset();
  return recovered;
}

void Daemon::turn() {
  const auto now = Clock::now();
  busy_ = false;
  try {
    if (!work_) {
      if (!journal_patience_.may_try(now)) return;
      const auto begun = begin_work();
      journal_patience_.note(begun, now, settings_.daemon.retry_seconds);
      if (!begun) return;
    }
    step();
    busy_ = work_->journal.changes() != changes_;
    changes_ = work_->journal.changes();
  } catch (const JournalError& error) {
    journal_failed(error.what());
  }
}

// Nobody knows what of the last step is recorded: as after a crash, only the journal does.
void Daemon::journal_failed(const std::string& why) {
  work_.reset();
  journal_patience_.note(Error{ErrorKind::temporary, why}, Clock::now(), settings_.daemon.retry_seconds);
}

void Daemon::step() {
  const auto now = Clock::now();
  const double retry_seconds = settings_.daemon.retry_seconds;
  work_->pipeline.collect();
  if (!stop_deadline_ && intake_patience_.may_try(now)) {
    intake_patience_.note(work_->intake.step(now), now, retry_seconds);
    if (work_->intake.scanned() && !work_->scanned_ms) work_->scanned_ms = wall_clock_ms();
  }
  if (!stop_deadline_ && work_->scanned_ms && start_patience_.may_try(now))
    start_patience_.note(work_->pipeline.start_due(closing()), now, retry_seconds);
  if (settle_patience_.may_try(now)) settle_patience_.note(work_->pipeline.settle(), now, retry_seconds);
  purge_archive_if_due(now);
}

void Daemon::purge_archive_if_due(MonotonicTime now) {
  if (!settings_.daemon.keep_archive_days || (next_purge_ && now < *next_purge_)) return;
  next_purge_ = now + std::chrono::hours(1);
  const std::int64_t before_ms = wall_clock_ms() - milliseconds(*settings_.daemon.keep_archive_days * 86400);
  const auto removed = purge_archive(folders_.archive, before_ms);
  if (!removed)
    log(Level::warning, removed.error().message);
  else if (*removed > 0)
    log(Level::information, fmt::format("{} files removed from the archive: older than keep_archive_days", *removed));
}

Closing Daemon::closing() {
  Closing closing;
  closing.now_ms = wall_clock_ms();
  closing.scanned_ms = work_->scanned_ms.value_or(closing.now_ms);
  closing.oldest_undecided_ms = work_->intake.oldest_undecided_ms();
  closing.close_all = once_ && work_->intake.drained() && work_->journal.ingest_counts(0).waiting == 0;
  return closing;
}

void Daemon::wait() {
  std::vector<pollfd> descriptors = {{signals_.get(), POLLIN, 0}};
  if (work_ && !stop_deadline_ && work_->intake.descriptor() >= 0)
    descriptors.push_back({work_->intake.descriptor(), POLLIN, 0});
  if (work_) work_->pipeline.workers().add_to_poll(descriptors);
  std::int64_t timeout_ms = 0;
  try {
    timeout_ms = milliseconds_to_wait();
  } catch (const JournalError& error) {
    journal_failed(error.what());
  }
  ::poll(descriptors.data(), descriptors.size(), static_cast<int>(timeout_ms));
}

std::int64_t Daemon::milliseconds_to_wait() {
  if (busy_) return 0;
  const auto now = Clock::now();
  MonotonicTime next = now + std::chrono::hours(1);
  const auto consider = [&](const std::optional<MonotonicTime>& time, const Patience& patience) {
    if (time) next = std::min(next, std::max(*time, patience.next_try().value_or(*time)));
  };
  const Patience none;
  consider(stop_deadline_, none);
  if (notification_.watchdog_interval_ms())
    consider(now + std::chrono::milliseconds(*notification_.watchdog_interval_ms()), none);
  for (const Patience* patience : {&journal_patience_, &intake_patience_, &start_patience_, &settle_patience_})
    consider(patience->next_try(), none);
  if (work_) consider(work_->pipeline.workers().next_deadline(), none);
  if (work_ && !stop_deadline_) {
    consider(work_->intake.next_due(), intake_patience_);
    const bool all_busy =
        work_->pipeline.workers().running() >= static_cast<std::size_t>(settings_.daemon.parallel_workers);
    // With all workers busy, the end of one of them is what to wait for.
    const auto due_ms = all_busy ? std::nullopt : work_->pipeline.next_due_ms(closing());
    if (due_ms) consider(now + std::chrono::milliseconds(*due_ms - wall_clock_ms()), start_patience_);
  }
  return std::clamp<std::int64_t>(std::chrono::ceil<std::chrono::milliseconds>(next - now).count(), 0, 3'600'000);
}

void Daemon::take_signals() {
  signalfd_siginfo signal{};
  while (::read(signals_.get(), &signal, sizeof signal) == sizeof signal) {
    if (signal.ssi_signo == SIGHUP)
      reload();
    else
      begin_stop();
  }
  if (stop_deadline_ && work_ && Clock::now() >= *stop_deadline_) work_->pipeline.workers().stop_all(SIGKILL);
}

void Daemon::begin_stop() {
  const auto now = Clock::now();
  if (stop_deadline_) {  // asked twice: at once
    stop_deadline_ = now;
    return;
  }
  stop_deadline_ = now + std::chrono::milliseconds(milliseconds(settings_.daemon.stop_timeout_seconds));
  notification_.stopping();
  log(Level::information, "stopping: no new work; workers may finish");
}

void Daemon::reload() {
  notification_.reloading();
  auto wanted = read_settings(settings_.path);
  Result<void> fine = wanted ? check_with_worker(*wanted) : wanted.error();
  if (fine) {
    if (auto difference = unchangeable_difference(settings_, *wanted))
      fine = Error{ErrorKind::configuration, *difference};
  }
  if (fine) fine = set_up_log(wanted->daemon.log);
  if (fine) {
    settings_ = std::move(*wanted);  // in place: everyone else refers to it
    if (work_) work_->intake.take_settings();
    log(Level::information, "the new configuration holds");
  } else {
    log(Level::error, "the new configuration is refused, the old one holds: " + fine.error().message);
  }
  busy_ = true;
  notification_.ready("watching " + folders_.inbox);
}

bool Daemon::is_over() {
  if (stop_deadline_) return !work_ || work_->pipeline.workers().running() == 0;
  if (!once_ || busy_ || !work_ || work_->pipeline.workers().running() > 0) return false;
  try {
    return work_->intake.drained() && !work_->pipeline.has_hopeful_work() && work_->journal.unsettled().empty();
  } catch (const JournalError& error) {
    return journal_failed(error.what()), false;
  }
}

int Daemon::exit_status() {
  if (stop_deadline_) return kExitStopped;
  const FileCounts counts = work_->journal.counts();
  if (counts.pending > 0 || work_->intake.oldest_undecided_ms()) return kExitPending;
  return work_->journal.quarantined_ever() > quarantined_before_ ? kExitQuarantined : 0;
}

}  // namespace thind
