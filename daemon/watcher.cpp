#include "daemon/watcher.h"

#include <sys/inotify.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace thind {
namespace {

constexpr std::uint32_t kArrivals = IN_CLOSE_WRITE | IN_MOVED_TO;
constexpr std::uint32_t kFolderGone = IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED | IN_UNMOUNT;

}  // namespace

Watcher::Watcher(std::string folder, bool poll_only) : folder_(std::move(folder)), poll_only_(poll_only) {
  renew();
}

void Watcher::renew() {
  if (!poll_only_ && !inotify_) watch();
}

void Watcher::watch() {
  inotify_ = Descriptor(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  const std::uint32_t mask = kArrivals | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
  problem_.clear();
  if (inotify_ && ::inotify_add_watch(inotify_.get(), folder_.c_str(), mask) >= 0) return;
  problem_ = "cannot watch " + folder_ + ": " + std::strerror(errno);
  inotify_.close();
}

Watcher::Events Watcher::take() {
  Events events;
  bool folder_gone = false;
  alignas(inotify_event) std::array<char, 65536> block;
  for (ssize_t count = 0; inotify_ && (count = ::read(inotify_.get(), block.data(), block.size())) > 0;) {
    for (const char* at = block.data(); at < block.data() + count;) {
      const auto* event = reinterpret_cast<const inotify_event*>(at);
      if (event->mask & IN_Q_OVERFLOW) events.rescan = true;
      if (event->mask & kFolderGone) folder_gone = true;
      if ((event->mask & kArrivals) && event->len > 0) events.names.emplace_back(event->name);
      at += sizeof(inotify_event) + event->len;
    }
  }
  if (folder_gone) {
    watch();
    events.rescan = true;
  }
  return events;
}

}  // namespace thind
