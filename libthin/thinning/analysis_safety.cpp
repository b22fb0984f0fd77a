#include "libthin/thinning/analysis_safety.h"

#include <fmt/format.h>

#include <cmath>

namespace thin {
namespace {

// With L wrong by more than this factor the gain over even thinning can turn into a loss.
constexpr double kLengthFactor = 2;
// With rho wrong upwards the retained are those that exaggerate.
constexpr double kRatioFactor = 2;
constexpr double kLeastPerSquareLength = 0.03;
constexpr double kMostPerSquareLength = 8;
constexpr double kMostGrossErrors = 0.05;

}  // namespace

std::vector<std::string> analysis_warnings(const AnalysisCircumstances& now) {
  std::vector<std::string> warnings;
  if (!now.values_are_innovations)
    warnings.emplace_back(
        "analysis thinning is for innovations: of temperatures it retains what differs from their mean");
  if (!now.length_is_given && !now.variogram)
    warnings.push_back(
        fmt::format("no correlation length can be fitted to these observations: {:.0f} km is taken; give "
                    "the assimilation's own as correlation_length_km",
                    now.correlation_length_km));
  if (now.length_is_given && now.variogram) {
    const double fitted_km = now.variogram->correlation_length_km;
    if (now.correlation_length_km > kLengthFactor * fitted_km || now.correlation_length_km * kLengthFactor < fitted_km)
      warnings.push_back(fmt::format(
          "correlation_length_km = {:.0f} is more than a factor of {:g} from the {:.0f} km of the observations' "
          "variogram: if it is not the assimilation's own, length_scales = \"two\" is safer",
          now.correlation_length_km, kLengthFactor, fitted_km));
  }
  if (now.ratio_is_given && now.variogram) {
    const double fitted = std::sqrt(now.variogram->nugget / now.variogram->sill);
    if (now.error_ratio > 1 && now.error_ratio > kRatioFactor * fitted)
      warnings.push_back(fmt::format(
          "error_ratio = {:g} is more than a factor of {:g} above the {:.2f} of the observations' variogram: the more "
          "noise is assumed, the more the retained exaggerate; it must not exceed the assimilation's own",
          now.error_ratio, kRatioFactor, fitted));
  }
  if (now.retained_per_square_length < kLeastPerSquareLength)
    warnings.push_back(fmt::format(
        "{:.2g} observations are retained in an area of L²: between them the analysis is the first guess; retain more",
        now.retained_per_square_length));
  if (now.retained_per_square_length > kMostPerSquareLength)
    warnings.push_back(fmt::format(
        "{:.2g} observations are retained in an area of L²: fewer tell as much, and stand far enough apart for their "
        "errors to be independent",
        now.retained_per_square_length));
  if (now.gross_error_share > kMostGrossErrors)
    warnings.push_back(
        fmt::format("{:.1f} % of the observations are contradicted by their neighbours and were not retained: screen "
                    "them better, or "
                    "raise gross_error_check",
                    100 * now.gross_error_share));
  return warnings;
}

}  // namespace thin
