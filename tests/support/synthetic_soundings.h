#pragma once

// The set that speed is measured on: AMSU-A of NOAA-15 and NOAA-16 over sea as innovations, in the tracks of real
// orbits, from 2004-07-21T22:30Z on (thesis 6.5), eight channels, cut off at `count` observations. Every second field of
// view, like the black ones of a chess board: so as many as the thesis had, 27,367, span its three hours.

#include <algorithm>

#include "libthin/analysis/synthetic_atmosphere.h"
#include "libthin/observations/orbit.h"
#include "libthin/observations/scan_geometry.h"

namespace thin::test {

inline ObservationSet synthetic_innovations(std::size_t count, std::uint64_t seed = 1) {
  constexpr std::int64_t begin_ms = 1'090'449'000'000;
  constexpr int first_channel = 4, channel_count = 8;  // 5..12: the temperature channels
  const SyntheticAtmosphere atmosphere(seed);
  ObservationSet set;
  set.value_kind = ValueKind::innovation;
  for (int c = 0; c < channel_count; ++c) set.channels.push_back(first_channel + c + 1);
  set.reserve(count);
  for (std::int64_t line = 0; set.size() < count; ++line)
    for (const char* name : {"NOAA-15", "NOAA-16"}) {
      const Orbit orbit(*find_orbit(name));
      const std::int64_t line_begin_ms = begin_ms + line * kAmsuaLineMs;
      const auto views = amsua_scan_line(orbit, line_begin_ms);
      for (int fov = 1; fov <= kAmsuaFieldsOfView && set.size() < count; ++fov) {
        if ((line + fov) % 2 != 0) continue;
        const FieldOfView& view = views[static_cast<std::size_t>(fov - 1)];
        if (land_fraction(view.latitude_deg, view.longitude_deg) > 0.5) continue;
        ChannelValues values =
            atmosphere.measurement_k(view, {orbit.platform(), line_begin_ms, fov}, {.climatology = false});
        for (double& value : values) value -= kFlatMeanK;
        set.push_back({.latitude_deg = view.latitude_deg,
                       .longitude_deg = view.longitude_deg,
                       .time_ms = view.time_ms,
                       .platform = orbit.platform(),
                       .scan_line = static_cast<std::int32_t>(line),
                       .field_of_view = fov,
                       .surface = Surface::sea,
                       .source = {}},
                      std::span(values).subspan(first_channel, channel_count));
      }
    }
  return set.select(canonical_order(set));
}

}  // namespace thin::test
