#include "libthin/analysis/variant.h"

#include <algorithm>

#include "libthin/analysis/count_fitting.h"
#include "libthin/analysis/uniform_subset.h"

namespace thin {

std::vector<std::optional<std::int64_t>> numbers_for(const Variant& variant, const std::vector<int>& counts) {
  if (!variant.thinner->stops_at_count() && variant.fit.empty()) return {std::nullopt};
  std::vector<std::optional<std::int64_t>> list(counts.begin(), counts.end());
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

Result<std::optional<double>> aim_at(const Variant& variant, const ObservationSet& set,
                                     std::optional<std::int64_t> asked) {
  if (asked && variant.thinner->stops_at_count()) variant.thinner->set_retain_count(*asked);
  if (!asked || variant.thinner->stops_at_count()) return std::optional<double>();
  const Result<double> value =
      fit_to_count(*variant.thinner, variant.options, variant.fit, set, static_cast<std::size_t>(*asked));
  if (!value) return value.error();
  return std::optional(*value);
}

Result<Choice> choose_set(const Variant* variant, const std::string& label, const ObservationSet& set,
                          std::optional<std::int64_t> asked, std::uint64_t seed) {
  const std::size_t count = asked ? static_cast<std::size_t>(*asked) : set.size();
  if (!variant)
    return Choice{label == "farthest_point" ? farthest_point_subset(set.position_km, count)
                                            : random_subset(set.size(), count, seed)};
  const Result<std::optional<double>> aimed = aim_at(*variant, set, asked);
  if (!aimed) return aimed.error();
  return variant->thinner->thin(set);
}

}  // namespace thin
