#include "libthin/formats/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

Result<void> sync_to_disk(const std::string& path, int open_flags) {
  const int descriptor = ::open(path.c_str(), open_flags | O_CLOEXEC);
  if (descriptor < 0) return system_error("open", path, errno);
  const int failed = ::fsync(descriptor);
  const int error_number = errno;
  ::close(descriptor);
  if (failed) return system_error("sync", path, error_number);
  return {};
}

std::filesystem::path folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

}  // namespace

Result<void> publish_file(const std::string& temporary, const std::string& path) {
  if (Result<void> synced = sync_to_disk(temporary, O_RDONLY); !synced) return synced;
  if (std::rename(temporary.c_str(), path.c_str()) != 0)
    return system_error("rename " + temporary + " to", path, errno);
  return sync_to_disk(folder_of(path), O_RDONLY | O_DIRECTORY);
}

Result<void> write_text_atomically(const std::string& path, const std::string& text) {
  const std::string temporary = folder_of(path) / ("." + std::filesystem::path(path).filename().string() + ".tmp");
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  if (Result<void> written = write_file_bytes(temporary, {bytes, text.size()}); !written) return written;
  return publish_file(temporary, path);
}

}  // namespace thin
