#include "libthin/tools/thinned_error.h"

#include <set>

#include "libthin/analysis/common_error.h"
#include "libthin/estimation/gme_grid.h"

namespace thin {
namespace {

constexpr int kReportLevel = 6;

using Flags = std::vector<std::uint8_t>;

// Of P among the observations; of P0, where P is not a part of it.
Result<ThinnedError> error_of(const ObservationSet& set, const Flags& is_retained, const Flags& is_full,
                              double bandwidth_km) {
  const Places places = places_of(set);
  const auto table =
      neighbourhood_table(evaluation_places(gme_grid(kReportLevel), places, bandwidth_km), places, {bandwidth_km});
  if (!table) return table.error();
  const std::vector<double> values = set.values_or_zero();
  const auto error_where = [&](const Flags& counted) {
    return estimation_error(*table, values, set.channel_count(), is_retained, counted, is_full);
  };
  ThinnedError error{bandwidth_km, kReportLevel, error_where({}), {}};
  const auto is_of_full = [&](std::size_t i) { return is_full.empty() || is_full[i]; };
  std::set<std::int32_t> platforms;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (is_of_full(i)) platforms.insert(set.platform[i]);
  for (const std::int32_t platform : platforms) {
    Flags reached(table->evaluation_point_count(), 0);
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.platform[i] == platform && is_of_full(i))
        for (const std::uint32_t q : table->points_near(i)) reached[q] = 1;
    error.platforms[platform] = error_where(reached);
  }
  return error;
}

}  // namespace

Result<ThinnedError> thinned_error(const ObservationSet& set, const Retained& retained,
                                   const std::vector<Retained>& members, double bandwidth_km) {
  if (!members.empty()) {
    const FullAndMeans both = full_and_means(set, members);
    return error_of(both.observations, both.is_mean, both.is_full, bandwidth_km);
  }
  Flags is_retained(set.size(), 0);
  for (const std::uint32_t i : retained) is_retained[i] = 1;
  return error_of(set, is_retained, {}, bandwidth_km);
}

}  // namespace thin
