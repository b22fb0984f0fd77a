#include "libthin/foundation/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace thin {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  bool close() {
    const int closing = number_;
    number_ = -1;
    return closing < 0 || ::close(closing) == 0;
  }

 private:
  int number_;
};

Error open_error(const std::string& path, int error_number) {
  Error error = system_error("open", path, error_number);
  if (error_number == ENOENT || error_number == ENOTDIR || error_number == EACCES) error.kind = ErrorKind::input;
  return error;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file_bytes(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) return open_error(path, errno);
  struct stat facts {};
  if (::fstat(file.number(), &facts) != 0) return system_error("read", path, errno);
  if (S_ISDIR(facts.st_mode)) return Error{ErrorKind::input, "cannot read " + path + ": it is a folder; name files"};

  // One byte more than the file is said to hold, so that its end is met without growing the vector.
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::max<off_t>(facts.st_size, 0)) + 1);
  std::size_t used = 0;
  for (;;) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t count = ::read(file.number(), bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error("read", path, errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
  }
  bytes.resize(used);
  return bytes;
}

Result<void> write_file_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.number() < 0) return system_error("create", path, errno);
  struct stat facts {};
  const bool removable = ::fstat(file.number(), &facts) == 0 && S_ISREG(facts.st_mode);
  const auto fail = [&](int error_number) {
    if (removable) ::unlink(path.c_str());
    return system_error("write", path, error_number);
  };
  while (!bytes.empty()) {
    const ssize_t count = ::write(file.number(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail(errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  // Network and quota file systems may report a full disk only here.
  if (!file.close()) return fail(errno);
  return {};
}

}  // namespace thin
