#include "libthin/estimation/bandwidth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "libthin/estimation/gaussian_filter.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

constexpr double kLeastKm = 1;
constexpr double kLargestKm = 500;
constexpr double kStep = 1.02;
constexpr double kShareOfBound = 0.05;  // thesis 6.4.2

// |est(p) - f(p)| per channel.
void misfit_at(const KdTree& tree, const Places& places, std::span<const double> values, std::size_t channels,
               const GaussianFilter& filter, std::size_t p, bool leave_one_out, std::vector<Neighbour>& found,
               double* misfit) {
  tree.radius_search(places.of(p), filter.radius_km(), found);
  double weights = 0;
  std::fill(misfit, misfit + channels, 0.0);
  for (const Neighbour& neighbour : found) {
    if ((leave_one_out && neighbour.index == p) || places.group_of(neighbour.index) != places.group_of(p)) continue;
    const double weight = filter.weight(neighbour.distance_squared);
    weights += weight;
    for (std::size_t c = 0; c < channels; ++c) misfit[c] += weight * values[neighbour.index * channels + c];
  }
  for (std::size_t c = 0; c < channels; ++c)
    misfit[c] = std::abs((weights > 0 ? misfit[c] / weights : 0.0) - values[p * channels + c]);
}

std::vector<double> variances(std::span<const double> values, std::size_t channels) {
  const std::size_t n = channels ? values.size() / channels : 0;
  std::vector<double> result(channels, 0.0);
  for (std::size_t c = 0; c < channels; ++c) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) sum += values[i * channels + c];
    for (std::size_t i = 0; i < n; ++i) squares += std::pow(values[i * channels + c] - sum / static_cast<double>(n), 2);
    result[c] = squares / static_cast<double>(std::max<std::size_t>(n, 1));
  }
  return result;
}

// The mean distance to the nearest other observation, of a sample.
double spacing_km(const Places& places) {
  const KdTree tree(places.coordinates, places.dimension);
  std::vector<Neighbour> found;
  double sum = 0, count = 0;
  const std::size_t stride = std::max<std::size_t>(1, places.size() / 500);
  for (std::size_t p = 0; p < places.size(); p += stride) {
    tree.nearest(places.of(p), 2, found);
    if (found.size() < 2) continue;
    sum += std::sqrt(found.back().distance_squared);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

std::vector<double> filter_misfit(const Places& places, std::span<const double> values, std::size_t channels,
                                  double bandwidth_km, bool leave_one_out) {
  const KdTree tree(places.coordinates, places.dimension);
  const GaussianFilter filter{bandwidth_km};
  const std::size_t stride = (places.size() + kBandwidthSample - 1) / kBandwidthSample;
  const std::size_t sample = places.size() ? (places.size() + stride - 1) / stride : 0;
  std::vector<double> misfits(sample * channels);
  parallel_ranges(sample, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i)
      misfit_at(tree, places, values, channels, filter, i * stride, leave_one_out, found, &misfits[i * channels]);
  });
  std::vector<double> means(channels, 0.0);
  for (std::size_t i = 0; i < misfits.size(); ++i)
    means[i % channels] += leave_one_out ? misfits[i] * misfits[i] : misfits[i];
  for (double& mean : means) mean /= static_cast<double>(std::max<std::size_t>(sample, 1));
  return means;
}

std::optional<double> cross_validated_bandwidth_km(const Places& places, std::span<const double> values,
                                                   std::size_t channels) {
  const double spacing = spacing_km(places);
  if (spacing <= 0) return std::nullopt;
  const std::vector<double> variance = variances(values, channels);
  const auto misfit = [&](double bandwidth_km) {
    const std::vector<double> squared = filter_misfit(places, values, channels, bandwidth_km, true);
    double sum = 0;
    for (std::size_t c = 0; c < channels; ++c) sum += variance[c] > 0 ? squared[c] / variance[c] : 0;
    return sum;
  };
  // Upwards from less than the spacing until the misfit has risen for a while, then finer around the best.
  constexpr double coarse = 1.3;
  double best = std::max(kLeastKm, spacing / 2), least = misfit(best);
  int worse = 0;
  for (double h = best * coarse; h <= kLargestKm && worse < 3; h *= coarse) {
    const double here = misfit(h);
    worse = here < least ? 0 : worse + 1;
    if (here < least) best = h, least = here;
  }
  for (double factor = std::sqrt(coarse); factor > kStep; factor = std::sqrt(factor))
    for (const double h : {best / factor, best * factor})
      if (const double here = misfit(h); here < least) best = h, least = here;
  return best;
}

std::optional<double> error_bound_bandwidth_km(const Places& places, std::span<const double> values,
                                               std::size_t channels, std::span<const double> error_bounds_k) {
  if (places.size() == 0) return std::nullopt;
  const auto is_met = [&](double bandwidth_km) {
    const std::vector<double> misfit = filter_misfit(places, values, channels, bandwidth_km, false);
    for (std::size_t c = 0; c < channels; ++c)
      if (misfit[c] > kShareOfBound * error_bounds_k[c]) return false;
    return true;
  };
  double met = kLeastKm, missed = kLargestKm;
  if (!is_met(met)) return std::nullopt;
  if (is_met(missed)) return missed;
  while (missed / met > kStep) {
    const double middle = std::sqrt(met * missed);
    (is_met(middle) ? met : missed) = middle;
  }
  return met;
}

void BandwidthOptions::declare(OptionTable& table) {
  table.add("bandwidth_km", bandwidth_km,
            {.unit = "km",
             .maximum = 5000,
             .above = 0,
             .explanation = fmt::format("h of the Gaussian filter, cut off at 3h; {:g} unless bandwidth says otherwise",
                                        kDefaultBandwidthKm)});
  table.add_choice("bandwidth", rule,
                   std::vector<std::pair<std::string, Rule>>{
                       {"fixed", Rule::fixed}, {"auto", Rule::cross_validation}, {"error_bound", Rule::error_bound}},
                   {.explanation = "fixed: bandwidth_km; auto: the h that predicts an observation from its neighbours "
                                   "best; error_bound: the largest h that changes the observations by at most 5 % of "
                                   "error_bounds on average (thesis 6.4.2: with noise, about their spacing)"});
  table.add("error_bounds", error_bounds_k,
            {.unit = "K",
             .explanation = "for bandwidth = \"error_bound\": the largest measurement error of each channel in use, in "
                            "their order"});
}

std::optional<BandwidthOptions::Conflict> BandwidthOptions::conflict() const {
  if (rule != Rule::fixed && bandwidth_km)
    return Conflict{"bandwidth_km", "is given, but bandwidth asks for a rule; remove one"};
  if ((rule == Rule::error_bound) != !error_bounds_k.empty())
    return Conflict{"error_bounds", "and bandwidth = \"error_bound\" need each other"};
  return std::nullopt;
}

Result<double> BandwidthOptions::choose(const Places& places, std::span<const double> values,
                                        std::size_t channels) const {
  if (rule == Rule::fixed) return bandwidth_km.value_or(kDefaultBandwidthKm);
  if (rule == Rule::cross_validation)
    return cross_validated_bandwidth_km(places, values, channels).value_or(kDefaultBandwidthKm);
  if (error_bounds_k.size() != channels)
    return Error{ErrorKind::configuration,
                 fmt::format("[thinning] error_bounds has {} numbers, but {} channels are in use; give one for each",
                             error_bounds_k.size(), channels)};
  if (places.size() == 0) return kDefaultBandwidthKm;
  const auto bandwidth = error_bound_bandwidth_km(places, values, channels, error_bounds_k);
  if (!bandwidth)
    return Error{
        ErrorKind::configuration,
        fmt::format("no bandwidth of {:g} km or more changes the observations by less than 5 % of error_bounds "
                    "on average; raise error_bounds, or use bandwidth = \"auto\"",
                    kLeastKm)};
  return *bandwidth;
}

}  // namespace thin
