// `thin window`: the files of a window are thinned together, and the outputs published.

#include <fmt/format.h>

#include <algorithm>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/pipeline.h"
#include "daemon/publication.h"
#include "daemon/quarantine.h"

namespace thind {
namespace {

std::string label_of(const WindowRecord& window, const std::vector<Member>& members) {
  if (window.kind != WindowKind::file) return window_name(window.interval, window.kind, window.version);
  return members.empty() ? "a file" : members.front().file.name;
}

std::vector<std::string> hashes_of(const std::vector<Member>& members) {
  std::vector<std::string> hashes;
  hashes.reserve(members.size());
  for (const Member& member : members) hashes.push_back(member.file.hash);
  return hashes;
}

}  // namespace

std::int64_t Pipeline::closing_time_of(const WindowRecord& window, const Closing& closing) {
  if (window.kind == WindowKind::file) return 0;
  const std::set<int>& expected = settings_.window.expected_platform_numbers;
  std::set<int> there;
  if (!expected.empty())
    for (const Member& member : journal_.members(window.id))
      there.insert(member.file.platforms.begin(), member.file.platforms.end());
  const bool all_there =
      !expected.empty() && std::includes(there.begin(), there.end(), expected.begin(), expected.end());
  const std::int64_t closing_ms =
      closing_time(window.interval, settings_.window.closing_rule(), window.last_arrival_ms, all_there);
  return std::max(closing_ms, closing.scanned_ms);
}

bool Pipeline::is_due(const WindowRecord& window, const Closing& closing) {
  if (window.not_before_ms > closing.now_ms) return false;
  if (window.kind != WindowKind::file && journal_.has_unfinished_before(window)) return false;
  if (!journal_.all_members_staged(window.id)) return false;
  if (window.kind == WindowKind::file || window.state == WindowState::probing || closing.close_all) return true;
  return may_close(closing_time_of(window, closing), closing.now_ms, closing.oldest_undecided_ms);
}

Result<void> Pipeline::start_window(const WindowRecord& window) {
  const std::vector<Member> members = journal_.members(window.id);
  if (members.empty()) {
    const std::string reason = "all of its files are in quarantine";
    journal_.record_outcome(window.id, {.state = WindowState::empty, .version = window.version, .reason = reason},
                            wall_clock_ms());
    log(Level::warning, label_of(window, members) + " has no output: " + reason);
    return {};
  }
  if (window.interruptions >= settings_.daemon.max_interruptions)
    return journal_.begin_probing(window.id), Result<void>();
  const std::string outputs = fmt::format("{}/{}window-{}", folders_.outbox, kUnfinishedPrefix, window.id);
  auto job =
      prepare({.kind = Job::Kind::window, .window = window.id, .outputs = outputs, .members = hashes_of(members)});
  if (!job) return job.error();
  if (auto written = write_plan(*job, window, members); !written) return written;
  journal_.begin_window_attempt(window.id);
  auto started = start(*job, {"window", "--plan", job->folder + "/plan.json", "--output", outputs});
  if (!started) journal_.excuse_window_attempt(window.id, retry_at(window.deferrals));
  return started;
}

Result<void> Pipeline::finish_window(const Job& job, WorkerExit exit) {
  WindowReport report = read_window_report(std::move(exit));
  const auto window = journal_.window(job.window);
  if (!window) return {};
  const std::vector<Member> members = journal_.members(job.window);
  const std::string label = label_of(*window, members);
  // A member was quarantined meanwhile, by another of its windows: what was made with it does not count.
  if (hashes_of(members) != job.members) return journal_.excuse_window_attempt(job.window, 0), Result<void>();
  switch (report.outcome) {
    case Outcome::done:
      return publish(*window, job, report);
    case Outcome::unusable:
      journal_.record_outcome(job.window,
                              {.state = WindowState::empty, .version = window->version, .reason = report.reason},
                              wall_clock_ms());
      log(Level::warning, fmt::format("{} has no output: {}", label, report.reason), {{"window", label}});
      return {};
    case Outcome::temporary:
    case Outcome::configuration:
    case Outcome::stopped:
      return put_off(*window, label, report), Result<void>();
    case Outcome::incomplete:
    case Outcome::failed:
      break;
  }
  fail_window(*window, report);
  return {};
}

void Pipeline::put_off(const WindowRecord& window, const std::string& label, const WorkerReport& report) {
  if (report.outcome == Outcome::stopped)
    return journal_.excuse_window_attempt(window.id, retry_after_stop(report.exit, window.deferrals));
  log(Level::warning, fmt::format("{} waits: {}", label, report.reason), {{"window", label}});
  journal_.excuse_window_attempt(window.id, retry_at(window.deferrals));
}

Result<void> Pipeline::publish(const WindowRecord& window, const Job& job, const WindowReport& report) {
  if (auto valid = validate_outputs(job.outputs, report); !valid) {
    WindowReport refused = report;
    refused.reason = valid.error().message;
    refused.outcome = Outcome::failed;
    return fail_window(window, refused), Result<void>();
  }
  WindowOutcome outcome{.state = WindowState::published, .version = window.version};
  Result<void> published;
  if (window.kind != WindowKind::file) {
    const auto name = [&](int version) { return window_name(window.interval, window.kind, version); };
    auto version = publish_folder(job.outputs, folders_.outbox, window.version, name);
    if (version) outcome.version = *version, outcome.output = name(*version);
    if (!version) published = version.error();
  } else if (report.outputs.empty()) {
    outcome.state = WindowState::empty;
    outcome.reason = "nothing of it was retained";
  } else {
    auto name = publish_file(job.outputs, folders_.outbox, report);
    if (name) outcome.output = *name;
    if (!name) published = name.error();
  }
  if (!published) return published;
  outcome.observations = report.observations;
  outcome.retained = report.retained;
  outcome.seconds = report.seconds;
  const std::vector<Member> members = journal_.members(window.id);
  journal_.record_outcome(window.id, outcome, wall_clock_ms());
  log(Level::information,
      fmt::format("{} published: {} of {} observations retained, from {} files", label_of(window, members),
                  report.retained, report.observations, members.size()),
      {{"window", outcome.output}});
  for (const Member& member : members) {
    const auto file = journal_.file(member.file.hash);
    if (!file || file->state != FileState::published) continue;
    log(Level::information, fmt::format("{} published {}", file->name, file->outcome),
        {{"file", file->name}, {"outcome", "published"}, {"sha256", file->hash}});
  }
  return {};
}

void Pipeline::fail_window(const WindowRecord& window, const WorkerReport& report) {
  const std::vector<Member> members = journal_.members(window.id);
  const std::string label = label_of(window, members);
  log(Level::warning, fmt::format("{} attempt {}: {}", label, window.attempts, report.reason), {{"window", label}});
  if (window.attempts < settings_.daemon.max_attempts)
    return journal_.end_window_attempt(window.id, report.reason, retry_at(window.attempts - 1));
  if (members.size() > 1) {
    log(Level::warning, label + " failed too often; its files are tried one by one", {{"window", label}});
    return journal_.begin_probing(window.id);
  }
  journal_.atomically([&] {
    for (const Member& member : members) remove_culprit(window, member.file, report);
    journal_.record_outcome(
        window.id, {.state = WindowState::failed, .version = window.version, .reason = report.reason}, wall_clock_ms());
  });
}

}  // namespace thind
