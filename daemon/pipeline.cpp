#include "daemon/pipeline.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/quarantine.h"

namespace thind {

Result<void> Pipeline::start_due(const Closing& closing) {
  const auto most = static_cast<std::size_t>(settings_.daemon.parallel_workers);
  const std::size_t free_workers = most - std::min(workers_.running(), most);  // after a reload there may be more
  for (const FileRecord& file : journal_.to_ingest(closing.now_ms, free_workers))
    if (auto started = start_ingest(file); !started) return started;
  for (const WindowRecord& window : journal_.unfinished_windows()) {
    if (!has_free_worker()) return {};
    if (window.running || !is_due(window, closing)) continue;
    auto started = window.state == WindowState::probing ? start_probe(window) : start_window(window);
    if (!started) return started;
  }
  return {};
}

void Pipeline::collect() {
  auto ended = workers_.collect();
  for (auto& [key, exit] : ended) {
    const Job job = jobs_.at(key);
    jobs_.erase(key);
    auto finished = job.kind == Job::Kind::ingest   ? finish_ingest(job, std::move(exit))
                    : job.kind == Job::Kind::window ? finish_window(job, std::move(exit))
                                                    : finish_probe(job, std::move(exit));
    if (!finished) excuse(job, finished.error());
    for (const std::string& folder : {job.folder, job.outputs})
      if (auto removed = folder.empty() ? Result<void>() : remove_tree(folder); !removed)
        log(Level::warning, removed.error().message);  // the next start removes it
  }
}

void Pipeline::excuse(const Job& job, const Error& error) {
  log(Level::warning, error.message + "; trying again");
  if (job.kind == Job::Kind::ingest) {
    const auto file = journal_.file(job.hash);
    journal_.excuse_file_attempt(job.hash, retry_at(file ? file->deferrals : 0));
  } else {
    const auto window = journal_.window(job.window);
    journal_.excuse_window_attempt(job.window, retry_at(window ? window->deferrals : 0));
  }
}

std::int64_t Pipeline::retry_after_stop(const WorkerExit& exit, std::int64_t deferrals) const {
  return exit.stopped ? 0 : retry_at(deferrals);
}

Result<void> Pipeline::settle() {
  for (const FileRecord& file : journal_.unsettled()) {
    if (!file.settled) {
      const std::string& folder = file.outcome == kLateOutcome ? folders_.late : folders_.archive;
      auto placed = file.state == FileState::quarantined
                        ? settle_quarantined(folders_, file)
                        : place_file(folders_.spooled(file.hash), folder, file.name, file.hash);
      if (!placed && placed.error().kind != ErrorKind::input) return placed.error();
      // Gone from the spool by someone else's hand: that can't be mended by trying again.
      if (!placed) log(Level::error, placed.error().message, {{"file", file.name}});
      journal_.record_settled(file.hash, placed ? *placed : "");
    }
    if (auto removed = remove_file(folders_.staged_file(file.hash)); !removed) return removed;
    journal_.record_unstaged(file.hash);
  }
  return {};
}

std::optional<std::int64_t> Pipeline::next_due_ms(const Closing& closing) {
  std::optional<std::int64_t> next;
  const auto consider = [&](std::int64_t time_ms) { next = std::min(next.value_or(time_ms), time_ms); };
  if (const auto ingest_ms = journal_.next_ingest_ms()) consider(*ingest_ms);
  for (const WindowRecord& window : journal_.unfinished_windows()) {
    if (window.running) continue;
    std::int64_t time_ms = window.not_before_ms;
    if (window.state == WindowState::open && !closing.close_all)
      time_ms = std::max(time_ms, closing_time_of(window, closing));
    // A window that is over its time waits for an event: the decision of a file, the end of an earlier version.
    if (time_ms > closing.now_ms) consider(time_ms);
  }
  return next;
}

bool Pipeline::has_hopeful_work() {
  const int limit = settings_.daemon.max_attempts;
  const auto files = journal_.ingest_counts(limit);
  if (files.waiting > 0) return files.hopeful > 0;
  const auto windows = journal_.unfinished_windows();
  return std::any_of(windows.begin(), windows.end(), [&](const WindowRecord& window) {
    return window.deferrals < limit && !journal_.has_unfinished_before(window);
  });
}

Result<Pipeline::Job> Pipeline::prepare(Job job) const {
  job.folder = folders_.work + "/" + std::to_string(last_job_ + 1);
  if (auto removed = remove_tree(job.folder); !removed) return removed.error();
  if (auto made = make_folder(job.folder); !made) return made.error();
  if (job.outputs.empty()) return job;
  if (auto removed = remove_tree(job.outputs); !removed) return removed.error();
  if (auto made = make_folder(job.outputs); !made) return made.error();
  return job;
}

Result<void> Pipeline::start(Job job, std::vector<std::string> arguments) {
  const DaemonSettings& daemon = settings_.daemon;
  auto configuration = configuration_for_workers();
  if (!configuration) return configuration.error();
  WorkerCommand command;
  command.arguments = {daemon.worker, arguments.front(), "--config", *configuration};
  command.arguments.insert(command.arguments.end(), arguments.begin() + 1, arguments.end());
  command.limits.wall_seconds = daemon.worker_timeout_seconds;
  command.limits.memory_bytes = std::int64_t{daemon.worker_memory_megabytes} << 20;
  command.limits.file_bytes = std::int64_t{daemon.worker_file_megabytes} << 20;
  // A worker's threads together may use more than the wall clock shows; this bounds one that escaped the clock.
  command.limits.cpu_seconds = static_cast<std::int64_t>(daemon.worker_timeout_seconds * 64) + 1;
  auto key = workers_.start(command);
  if (!key) return key.error();
  ++last_job_;
  jobs_.emplace(*key, std::move(job));
  return {};
}

// Workers read the file that the operator wrote (and paths in it from where it is) as long as it is what this daemon
// has read; once it was edited, and until SIGHUP, they get a copy of what this daemon has read.
Result<std::string> Pipeline::configuration_for_workers() const {
  const auto on_disk = read_file(settings_.path);
  if (on_disk && *on_disk == settings_.text) return settings_.path;
  const std::string copy = folders_.config + "/" + sha256_of(settings_.text).substr(0, 16) + ".toml";
  if (exists(copy)) return copy;
  if (auto written = write_file(copy, settings_.text); !written) return written.error();
  log(Level::warning, settings_.path + " has changed; the old configuration holds until SIGHUP");
  return copy;
}

Result<void> Pipeline::write_plan(const Job& job, const WindowRecord& window,
                                  const std::vector<Member>& members) const {
  using Json = nlohmann::ordered_json;
  Json plan;
  const bool whole_file = window.kind == WindowKind::file;
  plan["begin_ms"] = whole_file ? Json() : Json(window.interval.begin_ms);
  plan["end_ms"] = whole_file ? Json() : Json(window.interval.end_ms);
  plan["files"] = Json::array();
  std::set<std::string> names = {"report.json"};
  for (const auto& [file, probe] : members) {
    std::string name = plain_name(file.name, file.hash);
    if (!names.insert(name).second) names.insert(name = with_hash(name, file.hash));
    plan["files"].push_back(
        {{"name", name}, {"original", folders_.original(file)}, {"staged", folders_.staged_file(file.hash)}});
  }
  return write_file(job.folder + "/plan.json", plan.dump(1));
}

std::int64_t Pipeline::retry_at(std::int64_t vain_attempts) const {
  const auto doublings = std::clamp<std::int64_t>(vain_attempts, 0, 5);
  return wall_clock_ms() + milliseconds(settings_.daemon.retry_seconds) * (std::int64_t{1} << doublings);
}

bool Pipeline::has_free_worker() const {
  return workers_.running() < static_cast<std::size_t>(settings_.daemon.parallel_workers);
}

}  // namespace thind
