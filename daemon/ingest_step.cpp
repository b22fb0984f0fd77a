// `thin ingest`: a file from the spool is decoded, once, by a process that may die of it.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "daemon/assignment.h"
#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/pipeline.h"
#include "daemon/quarantine.h"
#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"

namespace thind {

Result<void> Pipeline::start_ingest(const FileRecord& file) {
  const std::string original = folders_.original(file);
  if (!exists(original)) {
    // Journaled and still on its way from the inbox; or gone by someone else's hand.
    if (file.state != FileState::seen) give_up_ingest(file, "has vanished from " + original, nullptr);
    return {};
  }
  if (file.interruptions >= settings_.daemon.max_interruptions) {
    give_up_ingest(file, fmt::format("was being decoded when the daemon died, {} times", file.interruptions), nullptr);
    return {};
  }
  auto job = prepare({.kind = Job::Kind::ingest, .hash = file.hash});
  if (!job) return job.error();
  journal_.begin_file_attempt(file.hash);
  auto started = start(*job, {"ingest", "--input", original, "--output", job->folder + "/staged.nc"});
  if (!started) journal_.excuse_file_attempt(file.hash, retry_at(file.deferrals));
  return started;
}

Result<void> Pipeline::finish_ingest(const Job& job, WorkerExit exit) {
  IngestReport report = read_ingest_report(std::move(exit));
  const auto file = journal_.file(job.hash);
  if (!file) return {};
  switch (report.outcome) {
    case Outcome::done:
      return accept_staged(*file, job, report);
    case Outcome::unusable:
      return give_up_ingest(*file, "can't be used: " + report.reason, &report), Result<void>();
    case Outcome::incomplete:
      if (file->state != FileState::seen) break;
      journal_.record_incomplete(file->hash, report.reason);
      log(Level::information, fmt::format("{} is incomplete and waits for its end: {}", file->name, report.reason),
          {{"file", file->name}, {"outcome", "incomplete"}});
      return intake_.give_back(*file);
    case Outcome::temporary:
    case Outcome::configuration:
      log(Level::warning, fmt::format("{} waits: {}", file->name, report.reason), {{"file", file->name}});
      return journal_.excuse_file_attempt(file->hash, retry_at(file->deferrals)), Result<void>();
    case Outcome::stopped:
      return journal_.excuse_file_attempt(file->hash, retry_after_stop(report.exit, file->deferrals)), Result<void>();
    case Outcome::failed:
      break;
  }
  fail_ingest(*file, report);
  return {};
}

Result<void> Pipeline::accept_staged(const FileRecord& file, const Job& job, IngestReport& report) {
  const std::string made = job.folder + "/staged.nc";
  if (!exists(made)) {
    report.reason = "the worker exited with 0, but left no staged file";
    report.outcome = Outcome::failed;
    return fail_ingest(file, report), Result<void>();
  }
  // Someone may have gone on writing to it under our hands; then it is not what the journal calls it.
  const auto content = sha256_of_file(folders_.original(file));
  if (!content) return content.error();
  if (*content != file.hash && file.state == FileState::seen) {
    journal_.record_incomplete(file.hash, "it was still being written");
    return intake_.give_back(file);
  }
  const auto windows = windows_between(settings_.window.grid(), report.staged.first_ms, report.staged.last_ms,
                                       settings_.daemon.max_windows_per_file);
  if (!windows && settings_.window.mode == WindowSettings::Mode::window && file.state == FileState::seen) {
    give_up_ingest(
        file,
        fmt::format("spans {} to {}, more windows than daemon.max_windows_per_file ({}): its times are wrong",
                    thin::to_iso8601(report.staged.first_ms), thin::to_iso8601(report.staged.last_ms),
                    settings_.daemon.max_windows_per_file),
        &report);
    return {};
  }
  if (auto synced = sync_path(made); !synced) return synced;
  if (std::rename(made.c_str(), folders_.staged_file(file.hash).c_str()) != 0)
    return thin::system_error("move to", folders_.staged_file(file.hash), errno);
  if (auto synced = sync_path(folders_.staged); !synced) return synced;
  journal_.atomically([&] {
    journal_.record_staged(file.hash, report.staged);
    if (file.state == FileState::seen)
      assign_to_windows(journal_, settings_, folders_, *journal_.file(file.hash), wall_clock_ms());
  });
  std::vector<std::string> platforms;
  for (const int platform : report.staged.platforms) platforms.push_back(thin::platform_name(platform));
  log(Level::information,
      fmt::format("{} staged: {} observations of {}, {} to {}{}", file.name, report.staged.observations,
                  fmt::join(platforms, ", "), thin::to_iso8601(report.staged.first_ms),
                  thin::to_iso8601(report.staged.last_ms),
                  report.skipped ? fmt::format("; {} parts of it could not be used", report.skipped) : ""),
      {{"file", file.name}, {"sha256", file.hash}});
  return {};
}

void Pipeline::fail_ingest(const FileRecord& file, const WorkerReport& report) {
  if (file.attempts >= settings_.daemon.max_attempts)
    return give_up_ingest(file, fmt::format("failed {} times to be decoded: {}", file.attempts, report.reason),
                          &report);
  log(Level::warning, fmt::format("{} attempt {}: {}", file.name, file.attempts, report.reason), {{"file", file.name}});
  journal_.end_file_attempt(file.hash, retry_at(file.attempts - 1));
}

void Pipeline::give_up_ingest(const FileRecord& file, const std::string& reason, const WorkerReport* report) {
  if (file.state != FileState::published) return quarantine_file(journal_, file, reason, report);
  // Its data is out; only a later version of its windows wanted it again.
  log(Level::error, file.name + " " + reason + "; it is left out of later versions of its windows");
  journal_.atomically([&] {
    journal_.excuse_file_attempt(file.hash, 0);
    journal_.leave_unfinished_windows(file.hash);
  });
}

}  // namespace thind
