#include "libthin/thinning/analysis_thinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "libthin/estimation/analysis_target.h"
#include "libthin/estimation/variogram.h"
#include "libthin/foundation/memory.h"
#include "libthin/thinning/greedy.h"
#include "libthin/thinning/refinement.h"

namespace thin {
namespace {

// Where no variogram can be fitted: the scale of a short-range background's errors in temperature.
constexpr double kDefaultLengthKm = 250;

// Evaluation points as near as this to each other say the same.
constexpr double kSpacingInLengths = 0.5;

// The target is the Gaussian filter with this h: it lets through what optimal interpolation from all does.
constexpr double kTargetBandwidthInLengths = 0.5;

// What an exchange must gain, as a share of J.
constexpr double kLeastExchangeGain = 1e-7;

// What the method works on: the observations that are believed, of n x channels values.
struct Believed {
  std::vector<std::uint32_t> indices;  // in the input, ascending
  Places places;
  std::vector<double> values;
  std::vector<double> priority;
  std::vector<Vector3> positions_km;
};

Believed believed(const ThinningInput& input, const std::vector<double>& values,
                  const std::vector<std::uint8_t>& is_wrong) {
  const auto channels = static_cast<std::ptrdiff_t>(input.channel_count());
  Believed result;
  for (std::uint32_t i = 0; i < input.size(); ++i) {
    if (is_wrong[i]) continue;
    result.indices.push_back(i);
    const auto row = values.begin() + i * channels;
    result.values.insert(result.values.end(), row, row + channels);
    if (!input.priority.empty()) result.priority.push_back(input.priority[i]);
    result.positions_km.push_back(input.observations.position_km[i]);
  }
  result.places = places_among(input.places, result.indices);
  return result;
}

// Mean squares, summed over channels.
double total_square(std::span<const double> values, std::size_t channels) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size() / channels);
}

}  // namespace

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
                            "the assimilation's own"});
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

Result<Choice> AnalysisThinning::choose(const ThinningInput& input) const {
  Choice choice;
  const std::size_t channels = input.channel_count();
  const auto variogram = fitted_variogram(input.places, input.values, channels);
  const double length_km =
      correlation_length_km_.value_or(variogram ? variogram->correlation_length_km : kDefaultLengthKm);
  const BackgroundCovariance covariance{
      length_km,
      length_scales_ == LengthScales::two || (length_scales_ == LengthScales::automatic && !correlation_length_km_)};
  const GaussianFilter filter{kTargetBandwidthInLengths * length_km};
  choice.bandwidth_km = filter.bandwidth_km;

  std::vector<std::uint8_t> is_wrong(input.size(), 0);
  if (gross_error_check_ > 0 && channels > 0)
    is_wrong = gross_errors(input.places, input.values, channels, filter, gross_error_check_);
  const Believed all = believed(input, input.values, is_wrong);

  const std::vector<std::uint32_t> points =
      spread_places(all.places, evaluation_spacing_km_.value_or(kSpacingInLengths * length_km));
  const std::vector<double> targets = filter_estimates(all.places, all.values, channels, points, filter);
  const double signal = total_square(all.values, channels) / (1 + error_ratio_ * error_ratio_);
  LocalAnalysis analysis(
      all.places, all.values, channels, points, targets,
      {.covariance = covariance, .error_ratio = error_ratio_, .coverage = coverage_weight_ * signal});

  const Separation separation(all.positions_km, input.min_separation_km);
  insert_greedily(analysis,
                  {.retain_count = std::min(input.retain_count.value_or(all.indices.size()), all.indices.size()),
                   .priority = all.priority,
                   .separation = &separation},
                  Update::full);
  if (exchange_) exchange(analysis, {.priority = all.priority, .separation = &separation}, kLeastExchangeGain);
  for (const std::uint32_t i : analysis.retained()) choice.retained.push_back(all.indices[i]);
  return choice;
}

}  // namespace thin
