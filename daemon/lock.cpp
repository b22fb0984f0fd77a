#include "daemon/lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace thind {

thin::Result<Lock> Lock::take(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!file) return thin::system_error("open the lock", path, errno);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return thin::system_error("lock", path, errno);
    std::array<char, 32> holder{};
    const ssize_t count = ::read(file.get(), holder.data(), holder.size());
    const std::string process = count > 0 ? std::string(holder.data(), static_cast<std::size_t>(count)) : "?";
    return thin::Error{thin::ErrorKind::configuration,
                       path + " is held by process " + process + ": one thind per inbox and state folder"};
  }
  const std::string process = std::to_string(::getpid());
  if (::ftruncate(file.get(), 0) != 0 || ::pwrite(file.get(), process.data(), process.size(), 0) < 0)
    return thin::system_error("write", path, errno);
  return Lock(std::move(file));
}

}  // namespace thind
