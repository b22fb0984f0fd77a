#pragma once

// Where a cross-track scanner looks: AMSU-A's 30 fields of view on the ellipsoid, with the angles that level 1C files
// hold beside them.
//
// The instrument looks down the ellipsoid's normal and scans at right angles to the flight as seen from the turning
// Earth, from the left of the flight (field of view 1) to its right (30), as in real files.

#include <array>
#include <cstdint>
#include <optional>

#include "libthin/observations/orbit.h"

namespace thin {

struct FieldOfView {
  std::int64_t time_ms = 0;
  double latitude_deg = 0;
  double longitude_deg = 0;          // -180..180
  double satellite_height_km = 0;    // above the ellipsoid, below the satellite
  double satellite_zenith_deg = 0;   // 0: the satellite is overhead
  double satellite_azimuth_deg = 0;  // from the field of view to the satellite, clockwise from north, 0..360
  double solar_zenith_deg = 0;       // above 90: night
  double solar_azimuth_deg = 0;      // as the satellite's
};

// NOAA KLM User's Guide, section 3.3: 8 s per scan, 30 fields of view in steps of 3 1/3 degrees, +-48 1/3 degrees. The
// time between two of them is as in level 1C files of NOAA-16 and NOAA-19.
constexpr int kAmsuaFieldsOfView = 30;
constexpr std::int64_t kAmsuaLineMs = 8000;
constexpr std::int64_t kAmsuaStepMs = 203;

// From nadir, positive to the right of the flight. REQUIRES: 1 <= field_of_view <= 30
double amsua_scan_angle_deg(int field_of_view);

// The field of view at this scan angle. Nothing where the ray misses the Earth (beyond about 60 degrees).
std::optional<FieldOfView> look(const Orbit& orbit, std::int64_t time_ms, double scan_angle_deg);

// The line whose first field of view is at this time; field of view f stands at f - 1.
std::array<FieldOfView, kAmsuaFieldsOfView> amsua_scan_line(const Orbit& orbit, std::int64_t begin_ms);

}  // namespace thin
