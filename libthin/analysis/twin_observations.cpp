#include "libthin/analysis/twin_observations.h"

#include <fmt/format.h>

#include <cmath>

#include "libthin/analysis/gaussian_field.h"
#include "libthin/analysis/synthetic_climatology.h"
#include "libthin/observations/orbit.h"
#include "libthin/observations/scan_geometry.h"

namespace thin {

void TwinObservationOptions::declare(OptionTable& table) {
  table.add("satellites", satellites, {.explanation = "whose AMSU-A observes, by name"});
  table.add("begin", begin, {.explanation = "of the first window, ISO 8601"});
  table.add("window_minutes", window_minutes,
            {.unit = "min", .minimum = 1, .maximum = 1440, .explanation = "observed in a window"});
  table.add("step", step,
            {.minimum = 1, .maximum = 10, .explanation = "every step-th field of view of every step-th scan line"});
  table.add("channels", channels, {.minimum = 1, .maximum = 15, .explanation = "observed fields"});
  table.add("observation_error_k", observation_error_k,
            {.unit = "K", .above = 0, .explanation = "white part of the observation errors"});
  table.add("correlated_error_k", correlated_error_k,
            {.unit = "K", .minimum = 0, .explanation = "correlated part; R in the assimilation stays diagonal"});
  table.add("correlated_length_km", correlated_length_km, {.unit = "km", .above = 0, .explanation = "of that part"});
  table.add("outlier_share", outlier_share,
            {.minimum = 0, .maximum = 1, .explanation = "share of the observations with a gross error besides"});
  table.add("outlier_size_k", outlier_size_k, {.unit = "K", .minimum = 0, .explanation = "of a gross error"});
  table.add("bias_k", bias_k, {.unit = "K", .explanation = "of all observations"});
}

double TwinObservationOptions::total_error_k() const {
  return std::hypot(observation_error_k, correlated_error_k);
}

Result<ObservationSet> twin_places(const TwinObservationOptions& options, std::int64_t begin_ms) {
  ObservationSet set;
  set.value_kind = ValueKind::innovation;
  for (int c = 1; c <= options.channels; ++c) set.channels.push_back(c);
  const std::vector<double> zero(set.channels.size(), 0);
  for (const std::string& name : options.satellites) {
    const auto elements = find_orbit(name);
    if (!elements)
      return Error{ErrorKind::configuration, fmt::format("satellites: no orbit is known for \"{}\"", name)};
    const Orbit orbit(*elements);
    const std::int64_t lines = std::int64_t{options.window_minutes} * 60'000 / kAmsuaLineMs;
    for (std::int64_t line = 0; line < lines; line += options.step) {
      const auto views = amsua_scan_line(orbit, begin_ms + line * kAmsuaLineMs);
      for (int fov = 1; fov <= kAmsuaFieldsOfView; fov += options.step) {
        const FieldOfView& view = views[static_cast<std::size_t>(fov - 1)];
        if (land_fraction(view.latitude_deg, view.longitude_deg) > 0.5) continue;
        set.push_back({.latitude_deg = view.latitude_deg,
                       .longitude_deg = view.longitude_deg,
                       .time_ms = view.time_ms,
                       .platform = orbit.platform(),
                       .instrument = Instrument::amsua,
                       .scan_line = static_cast<std::int32_t>(line),
                       .field_of_view = fov,
                       .surface = Surface::sea,
                       .source = {}},
                      zero);
      }
    }
  }
  return set.select(canonical_order(set));
}

TwinErrors twin_errors(const ObservationSet& places, const TwinObservationOptions& options, std::uint64_t seed) {
  const std::size_t n = places.size(), channels = places.channel_count();
  TwinErrors errors{normal_numbers(n * channels, seed), std::vector<std::uint8_t>(n, 0)};
  for (double& error : errors.errors_k) error = options.bias_k + options.observation_error_k * error;
  for (std::size_t c = 0; c < channels && options.correlated_error_k > 0; ++c) {
    const GaussianField field(seed + 101 + c, options.correlated_length_km);
    const std::vector<double> correlated = field.at(places.position_km);
    for (std::size_t i = 0; i < n; ++i) errors.errors_k[i * channels + c] += options.correlated_error_k * correlated[i];
  }
  if (options.outlier_share <= 0) return errors;
  // The lower tail of a normal number marks the outliers, another gives the sign.
  const std::vector<double> lots = normal_numbers(2 * n, seed + 51);
  for (std::size_t i = 0; i < n; ++i) {
    if (0.5 * std::erfc(-lots[2 * i] / std::sqrt(2.0)) >= options.outlier_share) continue;
    errors.is_outlier[i] = 1;
    for (std::size_t c = 0; c < channels; ++c)
      errors.errors_k[i * channels + c] += lots[2 * i + 1] < 0 ? -options.outlier_size_k : options.outlier_size_k;
  }
  return errors;
}

}  // namespace thin
