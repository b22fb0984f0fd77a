#include "daemon/assignment.h"

#include <algorithm>
#include <cassert>

#include "daemon/log.h"

namespace thind {
namespace {

// Open, and no worker at it yet: a plan that has been handed out is closed.
bool takes_members(const WindowRecord& window) {
  return window.state == WindowState::open && !window.running && window.attempts == 0;
}

class Assignment {
 public:
  Assignment(Journal& journal, const Folders& folders, const FileRecord& file, std::int64_t now_ms)
      : journal_(journal), folders_(folders), file_(file), now_ms_(now_ms) {}

  void to_interval(const Interval& interval, WindowSettings::Late late) {
    const auto window = journal_.latest_window(WindowKind::window, interval);
    if (!window) return join_new(WindowKind::window, interval, 1);
    if (takes_members(*window)) return join(window->id);
    switch (late) {
      case WindowSettings::Late::rethin:
        return to_next_version(*window);
      case WindowSettings::Late::separate:
        return to_late_data(interval);
      case WindowSettings::Late::drop:
        break;
    }
    journal_.add_dropped(window->id, file_.hash);
    say("is late for " + window_name(interval, WindowKind::window, window->version) + " and stays out of it");
  }

  void to_own_window() { join_new(WindowKind::file, {}, 1); }

 private:
  void to_next_version(const WindowRecord& closed) {
    const std::vector<Member> members = journal_.members(closed.id);
    const bool all_there = std::all_of(members.begin(), members.end(),
                                       [&](const Member& member) { return exists(folders_.original(member.file)); });
    if (!all_there) {
      log(Level::warning, "originals of " + closed.output + " have left the archive: late data is thinned separately");
      return to_late_data(closed.interval);
    }
    const std::int64_t next = journal_.create_window(WindowKind::window, closed.interval, closed.version + 1, now_ms_);
    for (const Member& member : members)
      if (member.file.state != FileState::quarantined) journal_.add_member(next, member.file.hash, now_ms_);
    say("is late: " + window_name(closed.interval, WindowKind::window, closed.version) + " is thinned again with it");
    join(next);
  }

  void to_late_data(const Interval& interval) {
    const auto latest = journal_.latest_window(WindowKind::late, interval);
    say("is late for " + window_name(interval, WindowKind::window, 1) + " and is thinned separately");
    if (latest && takes_members(*latest)) return join(latest->id);
    join_new(WindowKind::late, interval, latest ? latest->version + 1 : 1);
  }

  void join(std::int64_t window) { journal_.add_member(window, file_.hash, now_ms_); }
  void join_new(WindowKind kind, const Interval& interval, int version) {
    join(journal_.create_window(kind, interval, version, now_ms_));
  }
  void say(const std::string& what) { log(Level::information, file_.name + " " + what, {{"file", file_.name}}); }

  Journal& journal_;
  const Folders& folders_;
  const FileRecord& file_;
  std::int64_t now_ms_;
};

}  // namespace

void assign_to_windows(Journal& journal, const Settings& settings, const Folders& folders, const FileRecord& file,
                       std::int64_t now_ms) {
  journal.atomically([&] {
    Assignment assignment(journal, folders, file, now_ms);
    if (settings.window.mode == WindowSettings::Mode::per_file) return assignment.to_own_window();
    const auto intervals =
        windows_between(settings.window.grid(), *file.first_ms, *file.last_ms, settings.daemon.max_windows_per_file);
    assert(intervals);
    for (const Interval& interval : *intervals) assignment.to_interval(interval, settings.window.late);
    journal.publish_if_done(file.hash, now_ms);
  });
}

}  // namespace thind
