#include "daemon/file_system.h"

#include <fcntl.h>
#include <linux/fs.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "daemon/descriptor.h"

namespace thind {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
constexpr std::size_t kNameBytes = 255;

struct DigestDeleter {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new()) { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }
  void add(const void* bytes, std::size_t count) { EVP_DigestUpdate(context_.get(), bytes, count); }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned count = 0;
    EVP_DigestFinal_ex(context_.get(), bytes.data(), &count);
    std::string text;
    for (unsigned i = 0; i < count; ++i) {
      text += "0123456789abcdef"[bytes[i] >> 4];
      text += "0123456789abcdef"[bytes[i] & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, DigestDeleter> context_;
};

// Calls consume(bytes, count) for all that is left to read.
template <class Consume>
Result<void> read_all(int descriptor, const std::string& path, Consume consume) {
  std::string block(kBlockBytes, '\0');
  for (;;) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return thin::system_error("read", path, errno);
    if (count == 0) return {};
    if (auto consumed = consume(block.data(), static_cast<std::size_t>(count)); !consumed) return consumed;
  }
}

Result<void> write_all(int descriptor, const std::string& path, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t written = ::write(descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return thin::system_error("write", path, errno);
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
  return {};
}

Result<Descriptor> open_file(const std::string& path, int flags, mode_t mode = 0) {
  Descriptor file(::open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, mode));
  if (!file) return thin::system_error("open", path, errno);
  return file;
}

// A new file at `path` with the content of `from`, on the disk.
Result<void> copy_file(const std::string& from, const std::string& path) {
  auto source = open_file(from, O_RDONLY | O_NONBLOCK);
  if (!source) return source.error();
  auto target = open_file(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (!target) return target.error();
  const int out = target->get();
  auto copied = read_all(source->get(), from,
                         [&](const char* bytes, std::size_t count) { return write_all(out, path, bytes, count); });
  if (copied && ::fsync(out) != 0) return thin::system_error("sync", path, errno);
  return copied;
}

std::string parent_of(const std::string& path) {
  const std::string parent = fs::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

std::string temporary_beside(const std::string& path) {
  const fs::path full(path);
  return (full.parent_path() / (".tmp-" + sha256_of(full.filename().string()).substr(0, 32))).string();
}

}  // namespace

std::string sha256_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes.data(), bytes.size());
  return digest.hexadecimal();
}

Result<std::string> sha256_of_descriptor(int descriptor) {
  Digest digest;
  auto read = read_all(descriptor, "the file", [&](const char* bytes, std::size_t count) {
    digest.add(bytes, count);
    return Result<void>();
  });
  if (!read) return read.error();
  return digest.hexadecimal();
}

Result<std::string> sha256_of_file(const std::string& path) {
  auto file = open_file(path, O_RDONLY | O_NONBLOCK);
  if (!file) return file.error();
  return sha256_of_descriptor(file->get());
}

Result<std::string> sha256_of_beginning(const std::string& path, std::int64_t bytes) {
  auto file = open_file(path, O_RDONLY | O_NONBLOCK);
  if (!file) return file.error();
  Digest digest;
  auto left = static_cast<std::size_t>(bytes);
  auto read = read_all(file->get(), path, [&](const char* block, std::size_t count) {
    digest.add(block, std::min(count, left));
    left -= std::min(count, left);
    return Result<void>();
  });
  if (!read) return read.error();
  return digest.hexadecimal();
}

std::string path_in(const std::string& folder, std::string_view name) {
  std::string path;
  path.reserve(folder.size() + 1 + name.size());
  return path.append(folder).append("/").append(name);
}

bool exists(const std::string& path) {
  struct stat facts {};
  return ::lstat(path.c_str(), &facts) == 0;
}

Result<void> make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return thin::system_error("make the folder", path, error.value());
  return {};
}

Result<std::vector<std::string>> list_folder(const std::string& path) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) return thin::system_error("list", path, error.value());
  std::sort(names.begin(), names.end());
  return names;
}

Result<void> sync_path(const std::string& path) {
  auto file = open_file(path, O_RDONLY);
  if (!file) return file.error();
  if (::fsync(file->get()) != 0) return thin::system_error("sync", path, errno);
  return {};
}

Result<void> sync_tree(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    auto names = list_folder(path);
    if (!names) return names.error();
    for (const std::string& name : *names) {
      if (auto synced = sync_tree(path_in(path, name)); !synced) return synced;
    }
  }
  return sync_path(path);
}

Result<std::string> read_file(const std::string& path) {
  auto file = open_file(path, O_RDONLY | O_NONBLOCK);
  if (!file) return file.error();
  std::string text;
  auto read = read_all(file->get(), path, [&](const char* bytes, std::size_t count) {
    text.append(bytes, count);
    return Result<void>();
  });
  if (!read) return read.error();
  return text;
}

Result<void> write_file(const std::string& path, std::string_view text) {
  const std::string temporary = temporary_beside(path);
  {
    auto file = open_file(temporary, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (!file) return file.error();
    if (auto written = write_all(file->get(), temporary, text.data(), text.size()); !written) return written;
    if (::fsync(file->get()) != 0) return thin::system_error("sync", temporary, errno);
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) return thin::system_error("rename to", path, errno);
  return sync_path(parent_of(path));
}

Result<bool> rename_to_free(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno == EEXIST || errno == ENOTEMPTY) return false;
  if (errno != EINVAL && errno != ENOSYS) return thin::system_error("move " + from + " to", to, errno);
  // A file system without RENAME_NOREPLACE. One daemon writes here (it holds the lock), so looking first is enough.
  if (exists(to)) return false;
  if (::rename(from.c_str(), to.c_str()) != 0) return thin::system_error("move " + from + " to", to, errno);
  return true;
}

Result<bool> move_to_free(const std::string& from, const std::string& to) {
  struct stat source {
  }, folder{};
  if (::lstat(from.c_str(), &source) != 0) return thin::system_error("find", from, errno);
  if (::stat(parent_of(to).c_str(), &folder) != 0) return thin::system_error("find", parent_of(to), errno);
  std::string at_hand = from;
  if (source.st_dev != folder.st_dev) {
    if (exists(to)) return false;
    at_hand = temporary_beside(to);
    if (auto copied = copy_file(from, at_hand); !copied) return copied.error();
  }
  auto renamed = rename_to_free(at_hand, to);
  if (at_hand != from && !(renamed && *renamed)) ::unlink(at_hand.c_str());
  if (!renamed || !*renamed) return renamed;
  if (auto synced = sync_path(parent_of(to)); !synced) return synced.error();
  if (at_hand != from && ::unlink(from.c_str()) != 0) return thin::system_error("remove", from, errno);
  if (auto synced = sync_path(parent_of(from)); !synced) return synced.error();
  return true;
}

Result<std::string> place_file(const std::string& from, const std::string& folder, const std::string& name,
                               const std::string& hash) {
  const bool at_hand = exists(from);
  for (const std::string& candidate : {name, with_hash(name, hash), hash}) {
    const std::string target = path_in(folder, candidate);
    if (exists(target)) {
      auto found = sha256_of_file(target);
      if (!found || *found != hash) continue;
      if (auto removed = remove_file(from); !removed) return removed.error();
      return target;
    }
    if (!at_hand) continue;
    auto moved = move_to_free(from, target);
    if (!moved) return moved.error();
    if (*moved) return target;
  }
  return Error{ErrorKind::input, "the content of " + name + " is neither at " + from + " nor in " + folder};
}

Result<void> remove_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return thin::system_error("remove", path, errno);
  return {};
}

Result<void> remove_tree(const std::string& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) return thin::system_error("remove", path, error.value());
  return {};
}

Result<bool> same_content(const std::string& one, const std::string& other) {
  std::error_code error;
  const bool folder = fs::is_directory(one, error);
  if (folder != fs::is_directory(other, error)) return false;
  if (!folder) {
    auto first = sha256_of_file(one), second = sha256_of_file(other);
    if (!first) return first.error();
    if (!second) return second.error();
    return *first == *second;
  }
  auto first = list_folder(one), second = list_folder(other);
  if (!first) return first.error();
  if (!second) return second.error();
  if (*first != *second) return false;
  for (const std::string& name : *first) {
    auto same = same_content(path_in(one, name), path_in(other, name));
    if (!same || !*same) return same;
  }
  return true;
}

std::string with_hash(const std::string& name, const std::string& hash) {
  const std::string suffix = "-" + hash.substr(0, 8);
  const std::size_t dot = name.rfind('.');
  std::string extension = dot == std::string::npos || dot == 0 ? "" : name.substr(dot);
  std::string stem = name.substr(0, name.size() - extension.size());
  if (extension.size() > kNameBytes / 4) stem += std::exchange(extension, "");
  // Room is left for ".reason.json" as well.
  stem.resize(std::min(stem.size(), kNameBytes - suffix.size() - extension.size() - 16));
  return stem + suffix + extension;
}

std::string plain_name(const std::string& name, const std::string& hash) {
  std::string plain = name;
  for (char& letter : plain)
    if (letter < 0x20 || letter > 0x7e || letter == '/') letter = '_';
  return plain == name && name.size() + 16 <= kNameBytes ? plain : with_hash(plain, hash);
}

}  // namespace thind
