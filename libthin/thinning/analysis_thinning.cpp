#include "libthin/thinning/analysis_thinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/estimation/analysis_memory.h"
#include "libthin/estimation/analysis_target.h"
#include "libthin/foundation/memory.h"
#include "libthin/thinning/analysis_safety.h"
#include "libthin/thinning/greedy.h"
#include "libthin/thinning/refinement.h"

namespace thin {
namespace {

// Where no variogram can be fitted: the scale of a short-range background's errors in temperature.
constexpr double kDefaultLengthKm = 250;

// What is taken for rho from a variogram: below, thinning would follow the noise; above, it prefers what exaggerates.
constexpr double kLeastFittedRatio = 0.4;
constexpr double kLargestFittedRatio = 1;

// How far a covariance of one scale must reach, in L, for so many retained in an area of L² (local_analysis_test.cpp).
double reach_needed(double retained_per_square_length) {
  if (retained_per_square_length <= 3) return 3;
  return retained_per_square_length <= 6.5 ? 3.25 : 3.5;
}

double per_square_length(double within_reach, const BackgroundCovariance& covariance) {
  const double reach_in_lengths = covariance.radius_km() / covariance.correlation_length_km;
  return within_reach / (std::numbers::pi * reach_in_lengths * reach_in_lengths);
}

// Evaluation points as near as this to each other say the same.
constexpr double kSpacingInLengths = 0.5;

// The target is the Gaussian filter with this h: it lets through what optimal interpolation from all does.
constexpr double kTargetBandwidthInLengths = 0.5;

// What an exchange must gain, as a share of J.
constexpr double kLeastExchangeGain = 1e-7;

// Of a channel over its observations, as preparation sees it: a mean of more than this times the standard deviation is
// a bias, and makes the zero wrong that the analysis falls back to.
constexpr double kLargeMean = 0.5;

// The values with such means taken off, for what was prepared as a whole may be biased in a category.
std::vector<double> without_large_means(const ThinningInput& input, std::vector<std::string>& notes) {
  const ObservationSet& set = input.observations;
  const std::size_t channels = input.channel_count();
  std::vector<double> values = input.values;
  for (std::size_t c = 0; c < channels; ++c) {
    double count = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.measures(i, c)) ++count, sum += values[i * channels + c];
    if (count < 2) continue;
    const double mean = sum / count;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.measures(i, c)) squares += std::pow(values[i * channels + c] - mean, 2);
    const double deviation = std::sqrt(squares / count);
    if (deviation == 0 || std::abs(mean) <= kLargeMean * deviation) continue;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.measures(i, c)) values[i * channels + c] -= mean;
    notes.push_back(
        fmt::format("channel {}: a mean of {:.2f} standard deviations, a bias, was taken off for the choice",
                    set.channels[c], mean / deviation));
  }
  return values;
}

// Mean squares, summed over channels.
double total_square(std::span<const double> values, std::size_t channels) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size() / channels);
}

}  // namespace

AnalysisThinning::Believed::Believed(const ThinningInput& input, const std::vector<double>& all_values,
                                     const std::vector<std::uint8_t>& is_wrong) {
  const auto channels = static_cast<std::ptrdiff_t>(input.channel_count());
  for (std::uint32_t i = 0; i < input.size(); ++i) {
    if (is_wrong[i]) continue;
    indices.push_back(i);
    const auto row = all_values.begin() + i * channels;
    values.insert(values.end(), row, row + channels);
    if (!input.priority.empty()) priority.push_back(input.priority[i]);
    positions_km.push_back(input.observations.position_km[i]);
  }
  places = places_among(input.places, indices);
}

void AnalysisThinning::declare_options(OptionTable& table) {
  table.add("correlation_length_km", correlation_length_km_,
            {.unit = "km",
             .maximum = 5000,
             .above = 0,
             .explanation = "L of the background error covariance exp(-d^2/2L^2), the assimilation's own; unset: that "
                            "of the observations' variogram"});
  table.add_choice("length_scales", length_scales_,
                   std::vector<std::pair<std::string, LengthScales>>{
                       {"auto", LengthScales::automatic}, {"one", LengthScales::one}, {"two", LengthScales::two}},
                   {.explanation = "two: the covariance is the mean of those with 2/3 L and 4/3 L, for an L that is a "
                                   "guess; auto: two where L comes from a variogram"});
  table.add("error_ratio", error_ratio_,
            {.minimum = 0.02,
             .maximum = 50,
             .explanation = "rho, the standard deviation of the observation error over that of the background error, "
                            "the assimilation's own; unset: that of the variogram, from 0.4 to 1"});
  table.add("coverage_weight", coverage_weight_,
            {.minimum = 0,
             .maximum = 1000,
             .explanation = "lambda, what the uncertainty of the analysis counts beside its misfit: places "
                            "observations where the values say nothing"});
  table.add("gross_error_check", gross_error_check_,
            {.unit = "robust standard deviations",
             .minimum = 0,
             .maximum = 1000,
             .explanation = "observations that the estimate from their neighbours misses by more are not retained; 0: "
                            "all are believed"});
  table.add("exchange", exchange_,
            {.explanation = "after the greedy choice, swap the best retained against the best other observation "
                            "while J falls"});
  table.add("evaluation_spacing_km", evaluation_spacing_km_,
            {.unit = "km",
             .minimum = 0,
             .maximum = 5000,
             .explanation = "least spacing of the observations that J is taken at; 0: all; unset: L / 2"});
}

AnalysisThinning::Resolved AnalysisThinning::resolve(const ThinningInput& input, std::span<const double> values) const {
  Resolved resolved;
  resolved.variogram = fitted_variogram(input.places, values, input.channel_count());
  const auto& variogram = resolved.variogram;
  resolved.covariance.correlation_length_km =
      correlation_length_km_.value_or(variogram ? variogram->correlation_length_km : kDefaultLengthKm);
  resolved.covariance.two_scales =
      length_scales_ == LengthScales::two || (length_scales_ == LengthScales::automatic && !correlation_length_km_);
  const double fitted_ratio = variogram ? std::sqrt(variogram->nugget / variogram->sill) : kLeastFittedRatio;
  resolved.error_ratio = error_ratio_.value_or(std::clamp(fitted_ratio, kLeastFittedRatio, kLargestFittedRatio));
  return resolved;
}

std::vector<std::string> AnalysisThinning::notes(const Resolved& resolved, const ThinningInput& input,
                                                 const Believed& all, double retained_per_square_length) const {
  const BackgroundCovariance& covariance = resolved.covariance;
  std::vector<std::string> notes;
  if (!correlation_length_km_ || !error_ratio_)
    notes.push_back(fmt::format("the analysis is taken with L = {:.0f} km{}, error_ratio = {:.2f}",
                                covariance.correlation_length_km, covariance.two_scales ? " (two scales)" : "",
                                resolved.error_ratio));
  const std::size_t contradicted = input.size() - all.indices.size();
  if (contradicted > 0)
    notes.push_back(fmt::format("{} observations contradicted by their neighbours were not retained", contradicted));
  if (all.indices.empty()) return notes;
  const AnalysisCircumstances circumstances{
      .variogram = resolved.variogram,
      .correlation_length_km = covariance.correlation_length_km,
      .length_is_given = correlation_length_km_.has_value(),
      .error_ratio = resolved.error_ratio,
      .ratio_is_given = error_ratio_.has_value(),
      .retained_per_square_length = retained_per_square_length,
      .gross_error_share = static_cast<double>(contradicted) / static_cast<double>(input.size()),
      .values_are_innovations = input.observations.value_kind == ValueKind::innovation};
  for (std::string& warning : analysis_warnings(circumstances)) notes.push_back(std::move(warning));
  return notes;
}

Result<Choice> AnalysisThinning::choose(const ThinningInput& input) const {
  Choice choice;
  const std::size_t channels = input.channel_count();
  const std::vector<double> values = without_large_means(input, choice.notes);
  Resolved resolved = resolve(input, values);
  const GaussianFilter filter{kTargetBandwidthInLengths * resolved.covariance.correlation_length_km};
  choice.bandwidth_km = filter.bandwidth_km;

  std::vector<std::uint8_t> is_wrong(input.size(), 0);
  if (gross_error_check_ > 0) is_wrong = gross_errors(input.places, values, channels, filter, gross_error_check_);
  const Believed all(input, values, is_wrong);
  const std::size_t retain_count = std::min(input.retain_count.value_or(all.indices.size()), all.indices.size());

  const double spacing_km =
      evaluation_spacing_km_.value_or(kSpacingInLengths * resolved.covariance.correlation_length_km);
  const std::vector<std::uint32_t> points = spread_places(all.places, spacing_km);
  const double retained_share =
      static_cast<double>(retain_count) / static_cast<double>(std::max<std::size_t>(all.indices.size(), 1));
  const double retained_per_square_length =
      retained_share *
      per_square_length(observations_within_reach(all.places, points, resolved.covariance), resolved.covariance);
  if (!resolved.covariance.two_scales) resolved.covariance.reach_in_lengths = reach_needed(retained_per_square_length);
  if (Result<void> fits =
          expect_analysis_to_fit(all.places, points, resolved.covariance, retain_count, available_memory_bytes());
      !fits)
    return fits.error();
  for (std::string& note : notes(resolved, input, all, retained_per_square_length))
    choice.notes.push_back(std::move(note));

  // Of the mean square of the values the signal has so much, the noise the rest.
  const double signal = total_square(all.values, channels) / (1 + resolved.error_ratio * resolved.error_ratio);
  LocalAnalysis analysis(
      all.places, all.values, channels, points, filter_estimates(all.places, all.values, channels, points, filter),
      {.covariance = resolved.covariance, .error_ratio = resolved.error_ratio, .coverage = coverage_weight_ * signal});
  const Separation separation(all.positions_km, input.min_separation_km);
  insert_greedily(analysis, {.retain_count = retain_count, .priority = all.priority, .separation = &separation},
                  Update::full);
  if (exchange_) exchange(analysis, {.priority = all.priority, .separation = &separation}, kLeastExchangeGain);
  for (const std::uint32_t i : analysis.retained()) choice.retained.push_back(all.indices[i]);
  return choice;
}

}  // namespace thin
