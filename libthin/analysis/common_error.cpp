#include "libthin/analysis/common_error.h"

#include <algorithm>
#include <cmath>

#include "libthin/estimation/gme_grid.h"
#include "libthin/observations/mean_observations.h"

namespace thin {
namespace {

using Flags = std::vector<std::uint8_t>;

Flags flags_of(const Retained& retained, std::size_t n) {
  Flags flags(n, 0);
  for (const std::uint32_t p : retained) flags[p] = 1;
  return flags;
}

Places slice_of(const Places& places, std::size_t begin, std::size_t end) {
  const auto width = static_cast<std::size_t>(places.dimension);
  const auto cut = [](const auto& column, std::size_t from, std::size_t to) {
    return std::vector(column.begin() + static_cast<std::ptrdiff_t>(from),
                       column.begin() + static_cast<std::ptrdiff_t>(to));
  };
  Places slice;
  slice.dimension = places.dimension;
  slice.coordinates = cut(places.coordinates, begin * width, end * width);
  if (!places.group.empty()) slice.group = cut(places.group, begin, end);
  return slice;
}

// Sums of squares, from which the means are taken at the end.
void add(EstimationError& sums, const EstimationError& part) {
  const auto points = static_cast<double>(part.evaluation_point_count);
  sums.per_channel_k2.resize(part.per_channel_k2.size());
  for (std::size_t c = 0; c < part.per_channel_k2.size(); ++c)
    sums.per_channel_k2[c] += part.per_channel_k2[c] * points;
  sums.empty_mean_squared_k2 += part.empty_mean_squared_k2 * points;
  sums.evaluation_point_count += part.evaluation_point_count;
}

void take_means(EstimationError& sums) {
  const auto points = static_cast<double>(std::max<std::size_t>(sums.evaluation_point_count, 1));
  for (double& part : sums.per_channel_k2) {
    part /= points;
    sums.mean_squared_k2 += part;
  }
  sums.empty_mean_squared_k2 /= points;
}

Result<std::vector<EstimationError>> errors_at(const Places& points, const ObservationSet& set,
                                               const std::vector<Flags>& thinned, const CommonErrorOptions& options,
                                               const Flags& full = {}) {
  const Places observations = places_of(set);
  std::vector<EstimationError> errors(thinned.size());
  for (std::size_t begin = 0; begin < points.size(); begin += options.slice) {
    const Places slice = slice_of(points, begin, std::min(begin + options.slice, points.size()));
    const auto table = neighbourhood_table(slice, observations, {options.bandwidth_km});
    if (!table) return table.error();
    for (std::size_t i = 0; i < thinned.size(); ++i)
      add(errors[i], estimation_error(*table, set.values, set.channel_count(), thinned[i], {}, full));
  }
  for (EstimationError& error : errors) take_means(error);
  return errors;
}

}  // namespace

Result<std::vector<CommonError>> common_errors(const ObservationSet& set, std::span<const Retained> thinned_sets,
                                               const CommonErrorOptions& options) {
  std::vector<Flags> thinned;
  for (const Retained& retained : thinned_sets) thinned.push_back(flags_of(retained, set.size()));
  const Places observations = places_of(set);
  auto at_observations = errors_at(observations, set, thinned, options);
  if (!at_observations) return at_observations.error();
  auto on_grid =
      errors_at(evaluation_places(gme_grid(options.level), observations, options.bandwidth_km), set, thinned, options);
  if (!on_grid) return on_grid.error();
  std::vector<CommonError> errors;
  for (std::size_t i = 0; i < thinned.size(); ++i)
    errors.push_back({std::move((*at_observations)[i]), std::move((*on_grid)[i])});
  return errors;
}

FullAndMeans full_and_means(const ObservationSet& set, std::span<const Retained> members) {
  FullAndMeans both{set, Flags(set.size(), 1), Flags(set.size(), 0)};
  both.observations.append(mean_observations(set, members));
  both.is_full.resize(both.observations.size(), 0);
  both.is_mean.resize(both.observations.size(), 1);
  return both;
}

Result<CommonError> common_error_of_means(const ObservationSet& set, std::span<const Retained> members,
                                          const CommonErrorOptions& options) {
  const FullAndMeans both = full_and_means(set, members);
  const Places observations = places_of(set);
  const Places grid = evaluation_places(gme_grid(options.level), observations, options.bandwidth_km);
  CommonError error;
  for (const auto& [points, part] : {std::pair(&observations, &error.at_observations), {&grid, &error.on_grid}}) {
    auto errors = errors_at(*points, both.observations, {both.is_mean}, options, both.is_full);
    if (!errors) return errors.error();
    *part = std::move(errors->front());
  }
  return error;
}

double mean_absolute_value_k(const ObservationSet& set) {
  double sum = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    double squared = 0;
    for (const double value : set.values_of(i))
      if (!std::isnan(value)) squared += value * value;
    sum += std::sqrt(squared);
  }
  return set.size() > 0 ? sum / static_cast<double>(set.size()) : 0;
}

double signal_to_noise_db(double mean_absolute_value_k, double mean_squared_error_k2) {
  return 20 * std::log10(mean_absolute_value_k / std::sqrt(mean_squared_error_k2));
}

}  // namespace thin
