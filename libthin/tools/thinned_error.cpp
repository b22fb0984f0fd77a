#include "libthin/tools/thinned_error.h"

#include <set>

#include "libthin/estimation/gme_grid.h"

namespace thin {
namespace {

constexpr int kReportLevel = 6;

}  // namespace

Result<ThinnedError> thinned_error(const ObservationSet& set, const Retained& retained, double bandwidth_km) {
  const Places places = places_of(set);
  const auto table =
      neighbourhood_table(evaluation_places(gme_grid(kReportLevel), places, bandwidth_km), places, {bandwidth_km});
  if (!table) return table.error();
  const std::vector<double> values = set.values_or_zero();
  std::vector<std::uint8_t> is_retained(set.size(), 0);
  for (const std::uint32_t i : retained) is_retained[i] = 1;

  ThinnedError error{
      bandwidth_km, kReportLevel, estimation_error(*table, values, set.channel_count(), is_retained), {}};
  for (const std::int32_t platform : std::set<std::int32_t>(set.platform.begin(), set.platform.end())) {
    std::vector<std::uint8_t> reached(table->evaluation_point_count(), 0);
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.platform[i] == platform)
        for (const std::uint32_t q : table->points_near(i)) reached[q] = 1;
    error.platforms[platform] = estimation_error(*table, values, set.channel_count(), is_retained, reached);
  }
  return error;
}

}  // namespace thin
