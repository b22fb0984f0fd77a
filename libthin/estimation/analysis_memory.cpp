#include "libthin/estimation/analysis_memory.h"

#include <fmt/format.h>

#include <numeric>

#include "libthin/estimation/analysis_target.h"
#include "libthin/estimation/neighbourhood_table.h"

namespace thin {
namespace {

constexpr std::size_t kSample = 1000;

// A row's pairs, twice while the table is put together; a term's, and the lists of them.
constexpr double kBytesPerRowPair = 24;
constexpr double kBytesPerTermPair = 20;
constexpr double kBytesPerObservation = 400;

// Exchange adds to the terms of the greedy choice; at the most that was seen as many again.
constexpr double kTermsPerRetained = 2;

}  // namespace

double observations_within_reach(const Places& observations, std::span<const std::uint32_t> points,
                                 const BackgroundCovariance& covariance) {
  std::vector<std::uint32_t> sample;
  for (std::size_t i = 0; i < points.size(); i += points.size() / kSample + 1) sample.push_back(points[i]);
  if (sample.empty()) return 0;
  std::vector<std::size_t> counts(sample.size(), 0);
  each_neighbourhood(
      places_among(observations, sample), observations, covariance.filter(),
      [&](std::uint32_t q, std::span<const std::uint32_t> near, std::span<const double>) { counts[q] = near.size(); });
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0})) /
         static_cast<double>(counts.size());
}

Result<void> expect_analysis_to_fit(const Places& observations, std::span<const std::uint32_t> points,
                                    const BackgroundCovariance& covariance, std::size_t retain_count,
                                    std::uint64_t memory_bytes) {
  const double near = observations_within_reach(observations, points, covariance);
  const double rows = near * static_cast<double>(points.size());
  const bool has_terms = points.size() < observations.size();
  const double terms = has_terms ? kTermsPerRetained * near * static_cast<double>(retain_count) : 0;
  const double bytes = rows * kBytesPerRowPair + terms * kBytesPerTermPair +
                       kBytesPerObservation * static_cast<double>(observations.size());
  if (bytes <= static_cast<double>(memory_bytes)) return {};
  return Error{
      ErrorKind::configuration,
      fmt::format("{} observations, {} of them evaluation points, with {:.0f} others each within {:.0f} km, of "
                  "which {} are retained, need about {:.1f} GiB of memory where {:.1f} are left; choose a "
                  "larger evaluation_spacing_km, a smaller correlation_length_km, or shorter windows, or "
                  "retain fewer",
                  observations.size(), points.size(), near, covariance.radius_km(), retain_count, bytes / (1 << 30),
                  static_cast<double>(memory_bytes) / (1 << 30))};
}

}  // namespace thin
