#include "libthin/estimation/analysis_target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "libthin/estimation/neighbourhood_table.h"
#include "libthin/foundation/kd_tree.h"

namespace thin {
namespace {

constexpr double kDeviationsPerMedian = 1.4826022185056018;  // of a normal distribution

// Less weight than this of others is no estimate.
constexpr double kLeastWeight = 0.1;

// f less the estimate from the others that are not flagged; NaN where there is none.
std::vector<double> misses(const Places& places, std::span<const double> values, std::size_t channels,
                           const GaussianFilter& filter, const std::vector<std::uint8_t>& flags) {
  std::vector<double> result(values.size(), std::numeric_limits<double>::quiet_NaN());
  each_neighbourhood(places, places, filter,
                     [&](std::uint32_t q, std::span<const std::uint32_t> near, std::span<const double> weights) {
                       std::vector<double> sum(channels, 0.0);
                       double weight_sum = 0;
                       for (std::size_t i = 0; i < near.size(); ++i) {
                         if (near[i] == q || flags[near[i]]) continue;
                         weight_sum += weights[i];
                         for (std::size_t c = 0; c < channels; ++c)
                           sum[c] += weights[i] * values[near[i] * channels + c];
                       }
                       if (weight_sum < kLeastWeight) return;
                       for (std::size_t c = 0; c < channels; ++c)
                         result[q * channels + c] = values[q * channels + c] - sum[c] / weight_sum;
                     });
  return result;
}

double median_magnitude(std::span<const double> rows, std::size_t channel, std::size_t channels) {
  std::vector<double> magnitudes;
  for (std::size_t i = channel; i < rows.size(); i += channels)
    if (!std::isnan(rows[i])) magnitudes.push_back(std::abs(rows[i]));
  if (magnitudes.empty()) return 0;
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle;
}

}  // namespace

Places places_among(const Places& places, std::span<const std::uint32_t> chosen) {
  Places result;
  result.dimension = places.dimension;
  for (const std::uint32_t i : chosen) {
    const auto place = places.of(i);
    result.coordinates.insert(result.coordinates.end(), place.begin(), place.end());
    if (!places.group.empty()) result.group.push_back(places.group[i]);
  }
  return result;
}

std::vector<std::uint32_t> spread_places(const Places& places, double spacing_km) {
  std::vector<std::uint32_t> chosen;
  const KdTree tree(places.coordinates, places.dimension);
  std::vector<std::uint8_t> is_covered(places.size(), 0);
  std::vector<Neighbour> near;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    if (is_covered[i]) continue;
    chosen.push_back(i);
    if (spacing_km <= 0) continue;
    tree.radius_search(places.of(i), spacing_km, near);
    for (const Neighbour& other : near)
      if (places.group_of(other.index) == places.group_of(i)) is_covered[other.index] = 1;
  }
  return chosen;
}

std::vector<double> filter_estimates(const Places& places, std::span<const double> values, std::size_t channels,
                                     std::span<const std::uint32_t> points, const GaussianFilter& filter) {
  std::vector<double> estimates(points.size() * channels, 0.0);
  each_neighbourhood(places_among(places, points), places, filter,
                     [&](std::uint32_t q, std::span<const std::uint32_t> near, std::span<const double> weights) {
                       double weight_sum = 0;
                       double* estimate = &estimates[q * channels];
                       for (std::size_t i = 0; i < near.size(); ++i) {
                         weight_sum += weights[i];
                         for (std::size_t c = 0; c < channels; ++c)
                           estimate[c] += weights[i] * values[near[i] * channels + c];
                       }
                       for (std::size_t c = 0; c < channels; ++c) estimate[c] /= weight_sum;
                     });
  return estimates;
}

double limit_for_channels(double limit, std::size_t channels) {
  const auto false_alarms = [](double deviations) { return std::erfc(deviations / std::numbers::sqrt2); };
  const double wanted = false_alarms(limit) / static_cast<double>(channels);
  double low = limit, high = limit + 10;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (false_alarms(middle) > wanted ? low : high) = middle;
  }
  return low;
}

std::vector<std::uint8_t> gross_errors(const Places& places, std::span<const double> values, std::size_t channels,
                                       const GaussianFilter& filter, double limit) {
  std::vector<std::uint8_t> flags(places.size(), 0);
  std::vector<double> limits(channels, 0.0);
  for (const bool is_first : {true, false}) {
    const std::vector<double> missed = misses(places, values, channels, filter, flags);
    if (is_first)
      for (std::size_t c = 0; c < channels; ++c)
        limits[c] = limit_for_channels(limit, channels) * kDeviationsPerMedian * median_magnitude(missed, c, channels);
    std::fill(flags.begin(), flags.end(), std::uint8_t{0});
    for (std::size_t i = 0; i < missed.size(); ++i)
      if (std::abs(missed[i]) > limits[i % channels]) flags[i / channels] = 1;
  }
  return flags;
}

}  // namespace thin
