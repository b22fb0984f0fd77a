#include "daemon/archive.h"

#include <sys/stat.h>

#include "daemon/file_system.h"

namespace thind {

thin::Result<int> purge_archive(const std::string& folder, std::int64_t before_ms) {
  auto names = list_folder(folder);
  if (!names) return names.error();
  int removed = 0;
  for (const std::string& name : *names) {
    const std::string path = path_in(folder, name);
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode)) continue;
    // The time of modification is the sender's; that of the last change is when the file was moved here.
    if (facts.st_ctim.tv_sec * std::int64_t{1000} + facts.st_ctim.tv_nsec / 1'000'000 >= before_ms) continue;
    if (auto gone = remove_file(path); !gone) return gone.error();
    ++removed;
  }
  return removed;
}

}  // namespace thind
