#include "libthin/analysis/synthetic_innovations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "libthin/analysis/synthetic_atmosphere.h"
#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"
#include "libthin/observations/orbit.h"

namespace thin {
namespace {

constexpr std::int64_t kBeginMs = 1'090'449'000'000;         // 2004-07-21T22:30Z
constexpr std::size_t kFirstChannel = 4, kChannelCount = 8;  // 5..12: the temperature channels

ObservationSet empty_set(std::size_t channels, int first_channel, std::size_t count) {
  ObservationSet set;
  set.value_kind = ValueKind::innovation;
  for (std::size_t c = 0; c < channels; ++c) set.channels.push_back(first_channel + static_cast<int>(c));
  set.reserve(count);
  return set;
}

// Adds the observation with the truth.
void add(ObservationSet& set, const ObservationSet::Entry& entry, std::span<const double> values, bool signal_free,
         std::vector<double>& truth) {
  set.push_back(entry, values);
  truth.push_back(signal_free ? 1 : 0);
}

ObservationSet finished(ObservationSet set, std::vector<double> truth) {
  set.variables[kSignalFree] = std::move(truth);
  return set.select(canonical_order(set));
}

}  // namespace

ObservationSet orbit_innovations(std::size_t count, std::uint64_t seed, bool noise) {
  const SyntheticAtmosphere atmosphere(seed);
  ObservationSet set = empty_set(kChannelCount, kFirstChannel + 1, count);
  std::vector<double> truth;
  const Orbit orbits[] = {Orbit(*find_orbit("NOAA-15")), Orbit(*find_orbit("NOAA-16"))};
  for (std::int64_t line = 0; set.size() < count; ++line)
    for (const Orbit& orbit : orbits) {
      const std::int64_t line_begin_ms = kBeginMs + line * kAmsuaLineMs;
      const auto views = amsua_scan_line(orbit, line_begin_ms);
      for (int fov = 1; fov <= kAmsuaFieldsOfView && set.size() < count; ++fov) {
        if ((line + fov) % 2 != 0) continue;
        const FieldOfView& view = views[static_cast<std::size_t>(fov - 1)];
        if (land_fraction(view.latitude_deg, view.longitude_deg) > 0.5) continue;
        ChannelValues values = atmosphere.measurement_k(view, {orbit.platform(), line_begin_ms, fov},
                                                        {.noise = noise, .climatology = false});
        for (double& value : values) value -= kFlatMeanK;
        add(set,
            {.latitude_deg = view.latitude_deg,
             .longitude_deg = view.longitude_deg,
             .time_ms = view.time_ms,
             .platform = orbit.platform(),
             .scan_line = static_cast<std::int32_t>(line),
             .field_of_view = fov,
             .surface = Surface::sea,
             .source = {}},
            std::span(values).subspan(kFirstChannel, kChannelCount),
            atmosphere.is_flat(geocentric_km(view.latitude_deg, view.longitude_deg), view.time_ms), truth);
      }
    }
  return finished(std::move(set), std::move(truth));
}

ObservationSet spiral_innovations(std::size_t count, std::uint64_t seed, bool noise) {
  const SyntheticAtmosphere atmosphere(seed);
  struct Point {
    double latitude_deg, longitude_deg;
    ChannelValues values;
    bool signal_free;
  };
  std::vector<Point> points(count);
  parallel_ranges(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double height = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
      Point& point = points[i];
      point.latitude_deg = std::asin(height) * 180 / std::numbers::pi;
      point.longitude_deg = std::fmod(static_cast<double>(i) * 137.50776405003785, 360.0);
      const Vector3 place = geocentric_km(point.latitude_deg, point.longitude_deg);
      point.values = atmosphere.anomaly_k(place, kBeginMs);
      point.signal_free = atmosphere.is_flat(place, kBeginMs);
      if (!noise) continue;
      // Each point is a scan line of its own.
      const ChannelValues errors_k = atmosphere.noise_k({0, kBeginMs + static_cast<std::int64_t>(i), 1});
      for (std::size_t c = 0; c < errors_k.size(); ++c) point.values[c] += errors_k[c];
    }
  });

  ObservationSet set = empty_set(kChannelCount, kFirstChannel + 1, count);
  std::vector<double> truth;
  for (std::size_t i = 0; i < count; ++i)
    add(set,
        {.latitude_deg = points[i].latitude_deg,
         .longitude_deg = points[i].longitude_deg,
         .time_ms = kBeginMs,
         .platform = 0,
         .scan_line = 1,
         .field_of_view = static_cast<std::int32_t>(i) + 1,
         .source = {}},
        std::span(points[i].values).subspan(kFirstChannel, kChannelCount), points[i].signal_free, truth);
  return finished(std::move(set), std::move(truth));
}

ObservationSet gradient_innovations(std::size_t count, std::uint64_t seed, bool noise) {
  constexpr double side_km = 1000, ramp_km = 200, noise_k = 0.25;
  constexpr double km_per_degree = kEarthRadiusKm * std::numbers::pi / 180;
  std::mt19937_64 random(seed);
  // Not std::normal_distribution nor std::uniform_real_distribution, whose numbers differ from library to library.
  const auto unit = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  const auto normal = [&unit] {
    const double radius = std::sqrt(-2 * std::log(1 - unit()));
    return radius * std::cos(2 * std::numbers::pi * unit());
  };
  ObservationSet set = empty_set(1, 1, count);
  std::vector<double> truth;
  for (std::size_t i = 0; i < count; ++i) {
    const double east_km = side_km * (unit() - 0.5), north_km = side_km * (unit() - 0.5);
    double value = std::clamp(east_km / (ramp_km / 2), -1.0, 1.0);
    const bool signal_free = std::abs(value) == 1;
    if (noise) value += noise_k * normal();
    add(set,
        {.latitude_deg = north_km / km_per_degree,
         .longitude_deg = east_km / km_per_degree,
         .time_ms = kBeginMs,
         .platform = 0,
         .scan_line = 1,
         .field_of_view = static_cast<std::int32_t>(i) + 1,
         .source = {}},
        std::span(&value, 1), signal_free, truth);
  }
  return finished(std::move(set), std::move(truth));
}

void SyntheticOptions::declare(OptionTable& table) {
  table.add_choice("source", source,
                   std::vector<std::pair<std::string, Source>>{{"none", Source::none},
                                                               {"orbits", Source::orbits},
                                                               {"spiral", Source::spiral},
                                                               {"gradient", Source::gradient}},
                   {.explanation = "made-up innovations instead of files: orbits: AMSU-A channels 5 to 12 of two "
                                   "satellites over sea; spiral: the same channels evenly over the Earth; gradient: a "
                                   "ramp of 200 km in a square of 1,000 km"});
  table.add("count", count,
            {.unit = "observations", .minimum = 1, .maximum = 1e8, .explanation = "how many; 27,367 are the thesis's"});
  table.add("seed", seed, {.minimum = 0, .explanation = "of the weather, the places and the noise"});
  table.add("noise", noise, {.explanation = "with instrument noise (gradient: 0.25 K)"});
}

ObservationSet SyntheticOptions::make() const {
  const auto observations = static_cast<std::size_t>(count);
  const auto number = static_cast<std::uint64_t>(seed);
  if (source == Source::gradient) return gradient_innovations(observations, number, noise);
  if (source == Source::spiral) return spiral_innovations(observations, number, noise);
  return orbit_innovations(observations, number, noise);
}

}  // namespace thin
