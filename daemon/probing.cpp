// Whose fault is it that a window fails? Each member is thinned alone, into a scratch folder; who fails alone is it.

#include <fmt/format.h>

#include <algorithm>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/pipeline.h"
#include "daemon/publication.h"
#include "daemon/quarantine.h"

namespace thind {

Result<void> Pipeline::start_probe(const WindowRecord& window) {
  const std::vector<Member> members = journal_.members(window.id);
  const auto next =
      std::find_if(members.begin(), members.end(), [](const Member& member) { return member.probe == Probe::none; });
  if (next == members.end()) return end_probing(window), Result<void>();
  if (window.interruptions >= settings_.daemon.max_interruptions) {
    WindowReport report;
    report.reason = fmt::format("the daemon died {} times while this file was thinned alone", window.interruptions);
    return remove_culprit(window, next->file, report), Result<void>();
  }
  auto job = prepare({.kind = Job::Kind::probe,
                      .hash = next->file.hash,
                      .window = window.id,
                      .outputs = folders_.work + "/probe-" + std::to_string(window.id)});
  if (!job) return job.error();
  if (auto written = write_plan(*job, window, {*next}); !written) return written;
  journal_.begin_window_attempt(window.id);
  auto started = start(*job, {"window", "--plan", job->folder + "/plan.json", "--output", job->outputs});
  if (!started) journal_.excuse_window_attempt(window.id, retry_at(window.deferrals));
  return started;
}

Result<void> Pipeline::finish_probe(const Job& job, WorkerExit exit) {
  WindowReport report = read_window_report(std::move(exit));
  const auto window = journal_.window(job.window);
  const auto file = journal_.file(job.hash);
  if (report.outcome == Outcome::done) {
    if (auto valid = validate_outputs(job.outputs, report); !valid) {
      report.outcome = Outcome::failed;
      report.reason = valid.error().message;
    }
  }
  if (!window || !file) return {};
  switch (report.outcome) {
    case Outcome::done:
    case Outcome::unusable:
      return journal_.record_probe_passed(job.window, job.hash), Result<void>();
    case Outcome::temporary:
    case Outcome::configuration:
    case Outcome::stopped:
      return put_off(*window, window_name(window->interval, window->kind, window->version), report), Result<void>();
    case Outcome::incomplete:
    case Outcome::failed:
      break;
  }
  remove_culprit(*window, *file, report);
  return {};
}

void Pipeline::remove_culprit(const WindowRecord& window, const FileRecord& file, const WorkerReport& report) {
  const std::string reason = "makes the thinning of its window fail: " + report.reason;
  journal_.atomically([&] {
    journal_.record_culprit(window.id, file.hash);
    // What was published in another window stays published; it is only left out here.
    if (file.state == FileState::staged) quarantine_file(journal_, file, reason, &report);
  });
  if (file.state != FileState::staged) log(Level::error, file.name + " " + reason, {{"file", file.name}});
}

void Pipeline::end_probing(const WindowRecord& window) {
  // No worker ever failed at it and none of its files ends the daemon alone: the deaths that led here came from
  // outside.
  const bool only_interrupted = window.reason.empty();
  if (window.culprits > 0 || only_interrupted) return journal_.end_probing(window.id);
  const std::string label = window_name(window.interval, window.kind, window.version);
  const std::string reason = fmt::format("{} fails, but none of its files does alone: {}", label, window.reason);
  log(Level::error, reason, {{"window", label}});
  journal_.atomically([&] {
    for (const Member& member : journal_.members(window.id))
      if (member.file.state == FileState::staged)
        quarantine_file(journal_, member.file, "is part of a window that can't be thinned: " + reason, nullptr);
    journal_.record_outcome(
        window.id, {.state = WindowState::failed, .version = window.version, .reason = window.reason}, wall_clock_ms());
  });
}

}  // namespace thind
