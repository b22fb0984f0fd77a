#pragma once

// Orbits of the polar satellites that carry AMSU-A, simple and smooth: a circle whose node is turned by the Earth's
// oblateness (J2, first order) and below which the Earth turns (GMST, IAU 1982). Of the right shape and order for
// synthetic soundings, and not for collocation with real ones: eccentricity (about 0.001) and drag are left out.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

struct OrbitElements {
  std::int32_t platform = kUnknownNumber;  // WMO common code table C-5
  double altitude_km = 0;                  // above the equator
  double ascending_node_local_time_h = 0;  // mean local solar time at the northward crossing of the equator, 0..24
  std::int64_t launch_ms = 0;              // orbits are counted from here, where the first one begins at the equator
};

// The satellites that are known by name: NOAA-15..19, Metop-A..C, Aqua. Altitudes and crossing times are nominal or,
// for NOAA-15..17, which drifted, those of mid-2004 (WMO OSCAR/Space; NOAA KLM User's Guide, section 1.1), rounded.
const std::vector<OrbitElements>& known_orbits();

// As platform_name() spells it, any case.
std::optional<OrbitElements> find_orbit(const std::string& satellite_name);

class Orbit {
 public:
  // REQUIRES: 200 < altitude_km < 2000 (beyond, no inclination is sun-synchronous or the atmosphere ends the orbit)
  explicit Orbit(const OrbitElements& elements);

  // Earth-fixed. The velocity is that of the satellite as seen from the turning Earth.
  struct State {
    Vector3 position_km;
    Vector3 velocity_km_per_s;
  };
  State at(std::int64_t time_ms) const;

  // From one northward crossing of the equator to the next (nodal period). With n the mean motion and a the radius:
  // du/dt = n (1 + 3/2 J2 (R/a)^2 (4 cos^2 i - 1)), Vallado, Fundamentals of Astrodynamics, section 9.6, for e = 0.
  double period_s() const;

  // The one that keeps the node at one mean solar time: cos i = -(2/3) node rate (a/R)^2 / (J2 n). 98.2 to 98.9 degrees
  // for the satellites above, as published.
  double inclination_deg() const;

  std::int32_t platform() const { return elements_.platform; }

  // The orbit that contains this time, and when it began. 1 after launch; 0 and below for times before it.
  std::int64_t orbit_number(std::int64_t time_ms) const;
  std::int64_t orbit_begin_ms(std::int64_t orbit_number) const;

 private:
  OrbitElements elements_;
  double radius_km_;
  double inclination_rad_;
  double argument_rate_rad_per_s_;  // of the angle from the ascending node
};

// Angle from the vernal equinox to the Greenwich meridian, rad, 0..2 pi (IAU 1982, UT1 taken as UTC).
double greenwich_sidereal_angle_rad(std::int64_t time_ms);

// Unit vector towards the Sun, earth-fixed. Good to about 0.01 degree from 1950 to 2050 (The Astronomical Almanac's
// low- precision formulae).
Vector3 sun_direction(std::int64_t time_ms);

}  // namespace thin
