#include "libthin/preparation/duplicates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/instruments.h"
#include "libthin/preparation/space_time_index.h"

namespace thin {
namespace {

const std::vector<std::pair<std::string, DuplicatePreference>>& preference_names() {
  static const std::vector<std::pair<std::string, DuplicatePreference>> names = {
      {"file_order", DuplicatePreference::file_order},
      {"fewest_missing", DuplicatePreference::fewest_missing},
      {"earliest", DuplicatePreference::earliest},
      {"latest", DuplicatePreference::latest}};
  return names;
}

std::optional<std::string> understand_preference(const std::vector<std::string>& phrases,
                                                 std::vector<DuplicatePreference>& preference) {
  std::vector<std::string> known;
  for (const auto& [name, rule] : preference_names()) known.push_back(name);
  std::vector<DuplicatePreference> rules;
  for (const std::string& phrase : phrases) {
    const auto found = std::find(known.begin(), known.end(), phrase);
    if (found == known.end())
      return fmt::format("has the unknown rule \"{}\"; known are {}", phrase, fmt::join(known, ", "));
    rules.push_back(preference_names()[static_cast<std::size_t>(found - known.begin())].second);
  }
  preference = std::move(rules);
  return std::nullopt;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;  // the smaller index first

// All pairs of duplicates, ordered.
std::vector<Pair> duplicate_pairs(const ObservationSet& set, const DuplicateOptions& options) {
  std::map<Sounder, std::vector<std::uint32_t>> sounders;
  for (std::uint32_t i = 0; i < set.size(); ++i) sounders[sounder_of(set, i)].push_back(i);
  const Nearness nearness{options.distance_km, std::llround(options.minutes * 60'000)};

  std::vector<Pair> pairs;
  std::mutex mutex;
  for (const auto& [sounder, members] : sounders) {
    const SpaceTimeIndex index(set, members, nearness);
    parallel_ranges(members.size(), 1024, [&](std::size_t begin, std::size_t end) {
      std::vector<Pair> own;
      std::vector<std::uint32_t> found;
      for (std::size_t place = begin; place < end; ++place) {
        const std::uint32_t i = members[place];
        index.near(set.position_km[i], set.time_ms[i], found);
        for (const std::uint32_t j : found)
          if (j > i && set.field_of_view[j] == set.field_of_view[i]) own.emplace_back(i, j);
      }
      const std::scoped_lock lock(mutex);
      pairs.insert(pairs.end(), own.begin(), own.end());
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::size_t missing_count(const ObservationSet& set, std::size_t i) {
  const auto values = set.values_of(i);
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

bool equal_values(const ObservationSet& set, std::size_t a, std::size_t b) {
  const auto x = set.values_of(a), y = set.values_of(b);
  return std::equal(x.begin(), x.end(), y.begin(), [](double v, double w) {
    return std::bit_cast<std::uint64_t>(v) == std::bit_cast<std::uint64_t>(w);
  });
}

bool same_in_everything(const ObservationSet& set, std::size_t a, std::size_t b) {
  return set.time_ms[a] == set.time_ms[b] && set.position_km[a] == set.position_km[b] &&
         set.scan_line[a] == set.scan_line[b] && equal_values(set, a, b);
}

// Orders observations from the best to the worst.
class Preference {
 public:
  Preference(const ObservationSet& set, std::span<const std::string> file_names, const DuplicateOptions& options)
      : set_(set), options_(options) {
    for (const std::string& name : file_names) {
      const auto matches = [&](const std::string& pattern) { return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0; };
      file_rank_.push_back(std::find_if(options.file_order.begin(), options.file_order.end(), matches) -
                           options.file_order.begin());
    }
  }

  bool operator()(std::uint32_t a, std::uint32_t b) const {
    for (const DuplicatePreference rule : options_.preference) {
      const auto difference = key(rule, a) - key(rule, b);
      if (difference != 0) return difference < 0;
    }
    return a < b;
  }

 private:
  std::int64_t key(DuplicatePreference rule, std::uint32_t i) const {
    switch (rule) {
      case DuplicatePreference::file_order:
        return set_.source[i].file < file_rank_.size() ? file_rank_[set_.source[i].file] : 0;
      case DuplicatePreference::fewest_missing:
        return static_cast<std::int64_t>(missing_count(set_, i));
      case DuplicatePreference::earliest:
        return set_.time_ms[i];
      case DuplicatePreference::latest:
        return -set_.time_ms[i];
    }
    return 0;
  }

  const ObservationSet& set_;
  const DuplicateOptions& options_;
  std::vector<std::int64_t> file_rank_;
};

}  // namespace

void DuplicateOptions::declare(OptionTable& table) {
  table.add("remove_duplicates", remove,
            {.explanation = "of fields of view that are there twice (direct readout beside global data, messages sent "
                            "again) keep one"});
  table.add(
      "duplicate_distance_km", distance_km,
      {.unit = "km",
       .maximum = 1000,
       .above = 0,
       .explanation = "two observations of one satellite, instrument and field of view within this distance ..."});
  table.add("duplicate_minutes", minutes,
            {.unit = "min", .maximum = 1440, .above = 0, .explanation = "... and this time of each other are one"});
  table.add_phrases("duplicate_preference", preference_names_,
                    {.explanation = "which to keep, the first rule in which two differ decides: file_order, "
                                    "fewest_missing (channels), earliest, latest (time)"},
                    [this](const auto& phrases) { return understand_preference(phrases, preference); });
  table.add("duplicate_file_order", file_order,
            {.explanation = "patterns of file names (* and ?), the best source first, for the rule file_order"});
}

std::vector<Duplicate> find_duplicates(const ObservationSet& set, std::span<const std::string> file_names,
                                       const DuplicateOptions& options) {
  std::vector<Duplicate> duplicates(set.size(), Duplicate::none);
  if (!options.remove) return duplicates;
  std::map<std::uint32_t, std::vector<std::uint32_t>> others;
  for (const auto& [i, j] : duplicate_pairs(set, options)) {
    others[i].push_back(j);
    others[j].push_back(i);
  }
  std::vector<std::uint32_t> best_first;
  for (const auto& [i, near] : others) best_first.push_back(i);
  std::sort(best_first.begin(), best_first.end(), Preference(set, file_names, options));

  for (const std::uint32_t kept : best_first) {
    if (duplicates[kept] != Duplicate::none) continue;
    for (const std::uint32_t other : others[kept])
      if (duplicates[other] == Duplicate::none)
        duplicates[other] = same_in_everything(set, kept, other) ? Duplicate::exact : Duplicate::near;
  }
  return duplicates;
}

}  // namespace thin
