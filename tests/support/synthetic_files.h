#pragma once

// Small AMSU-A files in the tracks of real orbits, for tests of the whole way.

#include <string>
#include <vector>

#include "libthin/analysis/synthetic_atmosphere.h"
#include "libthin/formats/bufr_amsua_writer.h"
#include "libthin/observations/orbit.h"

namespace thin::test {

// `lines` scan lines of the satellite from begin_ms on; writes the file and returns its path.
inline std::string write_synthetic_file(const std::string& path, const std::string& satellite, std::int64_t begin_ms,
                                        int lines, AmsuaWriterOptions options = {}) {
  const SyntheticAtmosphere atmosphere(1);
  const Orbit orbit(*find_orbit(satellite));
  std::vector<AmsuaSounding> soundings;
  for (int line = 0; line < lines; ++line) {
    const std::int64_t line_begin_ms = begin_ms + line * kAmsuaLineMs;
    const auto views = amsua_scan_line(orbit, line_begin_ms);
    for (int fov = 1; fov <= kAmsuaFieldsOfView; ++fov) {
      const FieldOfView& view = views[static_cast<std::size_t>(fov - 1)];
      AmsuaSounding sounding{view, line + 1, fov, 1, {}};
      sounding.brightness_temperature_k = atmosphere.measurement_k(view, {orbit.platform(), line_begin_ms, fov}, {});
      soundings.push_back(sounding);
    }
  }
  const auto written = write_amsua_file(path, orbit.platform(), soundings, options);
  EXPECT_TRUE(written.ok()) << written.error().message;
  return path;
}

constexpr std::int64_t kSyntheticBeginMs = 1'090'449'000'000;  // 2004-07-21T22:30:00Z

}  // namespace thin::test
