#include "daemon/completeness.h"

#include <algorithm>

namespace thind {

void Completeness::observe(const std::string& name, const FileStamp& stamp, Time now, std::int64_t noticed_ms) {
  const auto [entry, is_new] = candidates_.try_emplace(name, Candidate{stamp, now, noticed_ms});
  if (is_new || entry->second.stamp == stamp) return;
  entry->second = {stamp, now, entry->second.noticed_ms};
}

void Completeness::set_waiting(const std::string& name, bool decided) {
  const auto found = candidates_.find(name);
  if (found == candidates_.end()) return;
  found->second.waiting = true;
  found->second.decided = decided;
}

std::vector<std::string> Completeness::due(Time now) const {
  std::vector<std::string> names;
  for (const auto& [name, candidate] : candidates_)
    if (!candidate.waiting && now >= candidate.since + settle_) names.push_back(name);
  return names;
}

std::optional<Completeness::Time> Completeness::next_due() const {
  std::optional<Time> next;
  for (const auto& [name, candidate] : candidates_)
    if (!candidate.waiting && (!next || candidate.since + settle_ < *next)) next = candidate.since + settle_;
  return next;
}

std::vector<std::string> Completeness::names() const {
  std::vector<std::string> names;
  for (const auto& [name, candidate] : candidates_) names.push_back(name);
  return names;
}

std::optional<std::int64_t> Completeness::noticed_ms(const std::string& name) const {
  const auto found = candidates_.find(name);
  return found == candidates_.end() ? std::nullopt : std::optional(found->second.noticed_ms);
}

const FileStamp* Completeness::stamp(const std::string& name) const {
  const auto found = candidates_.find(name);
  return found == candidates_.end() ? nullptr : &found->second.stamp;
}

std::optional<std::int64_t> Completeness::oldest_undecided_ms() const {
  std::optional<std::int64_t> oldest;
  for (const auto& [name, candidate] : candidates_)
    if (!candidate.decided && (!oldest || candidate.noticed_ms < *oldest)) oldest = candidate.noticed_ms;
  return oldest;
}

bool Completeness::all_waiting() const {
  return std::all_of(candidates_.begin(), candidates_.end(), [](const auto& entry) { return entry.second.waiting; });
}

}  // namespace thind
