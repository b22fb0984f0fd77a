#include "daemon/publication.h"

#include <sys/stat.h>

#include <cassert>
#include <map>

namespace thind {
namespace {

Error not_as_reported(const std::string& what) {
  return {ErrorKind::internal, "its outputs are not as reported: " + what};
}

}  // namespace

Result<void> validate_outputs(const std::string& folder, const WindowReport& report) {
  auto names = list_folder(folder);
  if (!names) return names.error();
  std::map<std::string, std::int64_t> expected;
  for (const OutputFile& output : report.outputs)
    if (!expected.emplace(output.name, output.bytes).second) return not_as_reported(output.name + " is listed twice");
  if (report.report.empty() || expected.contains(report.report)) return not_as_reported("there is no report");
  bool report_there = false;
  for (const std::string& name : *names) {
    struct stat facts {};
    const bool is_file = ::lstat(path_in(folder, name).c_str(), &facts) == 0 && S_ISREG(facts.st_mode);
    if (!is_file) return not_as_reported(name + " is no file");
    if (name == report.report) {
      report_there = true;
      continue;
    }
    const auto found = expected.find(name);
    if (found == expected.end()) return not_as_reported(name + " is not listed");
    if (found->second != facts.st_size)
      return not_as_reported(name + " has " + std::to_string(facts.st_size) + " bytes, not " +
                             std::to_string(found->second));
    expected.erase(found);
  }
  if (!expected.empty()) return not_as_reported(expected.begin()->first + " is missing");
  if (!report_there) return not_as_reported(report.report + " is missing");
  return {};
}

Result<int> publish_folder(const std::string& folder, const std::string& outbox, int version,
                           const std::function<std::string(int)>& name) {
  if (auto synced = sync_tree(folder); !synced) return synced.error();
  for (;; ++version) {
    const std::string target = outbox + "/" + name(version);
    auto renamed = rename_to_free(folder, target);
    if (!renamed) return renamed.error();
    if (!*renamed) {
      auto same = same_content(folder, target);
      if (!same) return same.error();
      if (!*same) continue;
      if (auto removed = remove_tree(folder); !removed) return removed.error();
    }
    if (auto synced = sync_path(outbox); !synced) return synced.error();
    return version;
  }
}

Result<std::string> publish_file(const std::string& folder, const std::string& outbox, const WindowReport& report) {
  assert(report.outputs.size() == 1);
  const std::string& output = report.outputs.front().name;
  const std::string from = folder + "/" + output, reports = outbox + "/reports";
  auto hash = sha256_of_file(from);
  if (!hash) return hash.error();
  auto text = read_file(folder + "/" + report.report);
  if (!text) return text.error();
  if (auto synced = sync_path(from); !synced) return synced.error();
  if (auto made = make_folder(reports); !made) return made.error();
  for (const std::string& name : {output, with_hash(output, *hash), *hash}) {
    const std::string target = path_in(outbox, name);
    const auto there = exists(target) ? sha256_of_file(target) : Result<std::string>(*hash);
    if (!there || *there != *hash) continue;
    if (auto written = write_file(path_in(reports, name).append(".json"), *text); !written) return written.error();
    auto moved = move_to_free(from, target);
    if (!moved) return moved.error();
    if (auto removed = remove_tree(folder); !removed) return removed.error();
    return name;
  }
  return Error{ErrorKind::internal, "all names for " + output + " are taken in " + outbox};
}

}  // namespace thind
