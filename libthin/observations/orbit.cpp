#include "libthin/observations/orbit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

// WGS84 and EGM96.
constexpr double kEquatorialRadiusKm = 6378.137;
constexpr double kGravityKm3PerS2 = 398600.4418;
constexpr double kJ2 = 1.08262668e-3;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kDayS = 86400;
constexpr double kEarthRateRadPerS = 360.98564736629 * kDegree / kDayS;

// The mean sun goes round once in a tropical year: what a sun-synchronous node must do.
constexpr double kMeanSunRadPerS = 0.98564736 * kDegree / kDayS;

// Days since J2000.0, 2000-01-01T12:00:00Z.
double julian_days(std::int64_t time_ms) {
  return static_cast<double>(time_ms - 946'728'000'000) / (kDayS * 1000);
}

// Mean longitude of the Sun, which is the right ascension of the mean sun.
double mean_sun_rad(double days) {
  return (280.460 + 0.98564736 * days) * kDegree;
}

double turn_of(double angle_rad) {
  const double rest = std::fmod(angle_rad, kTurn);
  return rest < 0 ? rest + kTurn : rest;
}

// From axes fixed among the stars to axes fixed in the Earth.
Vector3 earth_fixed(const Vector3& v, double sidereal_angle_rad) {
  const double c = std::cos(sidereal_angle_rad);
  const double s = std::sin(sidereal_angle_rad);
  return {c * v.x + s * v.y, c * v.y - s * v.x, v.z};
}

std::int64_t launch(const char* date) {
  return from_iso8601(date).value();
}

std::int32_t number(const char* name) {
  return platform_number(name).value();
}

}  // namespace

const std::vector<OrbitElements>& known_orbits() {
  static const std::vector<OrbitElements> orbits = {
      {number("NOAA-15"), 807, 18.3, launch("1998-05-13T15:52Z")},
      {number("NOAA-16"), 850, 14.8, launch("2000-09-21T10:22Z")},
      {number("NOAA-17"), 812, 22.4, launch("2002-06-24T18:23Z")},
      {number("NOAA-18"), 854, 13.9, launch("2005-05-20T10:22Z")},
      {number("NOAA-19"), 855, 13.8, launch("2009-02-06T10:22Z")},
      {number("Metop-A"), 820, 21.5, launch("2006-10-19T16:28Z")},
      {number("Metop-B"), 820, 21.5, launch("2012-09-17T16:28Z")},
      {number("Metop-C"), 820, 21.5, launch("2018-11-07T00:47Z")},
      {number("Aqua"), 705, 13.5, launch("2002-05-04T09:54Z")},
  };
  return orbits;
}

std::optional<OrbitElements> find_orbit(const std::string& satellite_name) {
  const auto platform = platform_number(satellite_name);
  const auto& orbits = known_orbits();
  const auto found = std::find_if(orbits.begin(), orbits.end(), [&](const auto& o) { return o.platform == platform; });
  return found == orbits.end() ? std::nullopt : std::optional(*found);
}

Orbit::Orbit(const OrbitElements& elements)
    : elements_(elements), radius_km_(kEquatorialRadiusKm + elements.altitude_km) {
  assert(elements.altitude_km > 200 && elements.altitude_km < 2000);
  const double mean_motion = std::sqrt(kGravityKm3PerS2 / (radius_km_ * radius_km_ * radius_km_));
  const double flattening_term = 1.5 * kJ2 * std::pow(kEquatorialRadiusKm / radius_km_, 2);
  const double cosine = -kMeanSunRadPerS / (flattening_term * mean_motion);
  inclination_rad_ = std::acos(cosine);
  argument_rate_rad_per_s_ = mean_motion * (1 + flattening_term * (4 * cosine * cosine - 1));
}

Orbit::State Orbit::at(std::int64_t time_ms) const {
  const double days = julian_days(time_ms);
  const double node = mean_sun_rad(days) + (elements_.ascending_node_local_time_h - 12) * 15 * kDegree;
  const double argument = argument_rate_rad_per_s_ * (static_cast<double>(time_ms - elements_.launch_ms) / 1000);
  const double cu = std::cos(argument), su = std::sin(argument);
  const double cn = std::cos(node), sn = std::sin(node);
  const double ci = std::cos(inclination_rad_), si = std::sin(inclination_rad_);

  // The circle, in the frame of the node: `across` is the direction of flight at the node.
  const Vector3 along{cn, sn, 0};
  const Vector3 across{-sn * ci, cn * ci, si};
  const auto combine = [&](double a, double b) {
    return Vector3{a * along.x + b * across.x, a * along.y + b * across.y, a * along.z + b * across.z};
  };
  const Vector3 position = combine(radius_km_ * cu, radius_km_ * su);
  const double speed = radius_km_ * argument_rate_rad_per_s_;
  Vector3 velocity = combine(-speed * su, speed * cu);
  // The node turns eastward with the plane, the Earth faster still.
  const double relative_rate = kMeanSunRadPerS - kEarthRateRadPerS;
  velocity.x -= relative_rate * position.y;
  velocity.y += relative_rate * position.x;

  const double sidereal_angle = greenwich_sidereal_angle_rad(time_ms);
  return {earth_fixed(position, sidereal_angle), earth_fixed(velocity, sidereal_angle)};
}

double Orbit::period_s() const {
  return kTurn / argument_rate_rad_per_s_;
}

double Orbit::inclination_deg() const {
  return inclination_rad_ / kDegree;
}

std::int64_t Orbit::orbit_number(std::int64_t time_ms) const {
  const double orbits = static_cast<double>(time_ms - elements_.launch_ms) / (1000 * period_s());
  const auto number = static_cast<std::int64_t>(std::floor(orbits)) + 1;
  // Right to the millisecond also where the division was rounded across the boundary.
  if (orbit_begin_ms(number) > time_ms) return number - 1;
  if (orbit_begin_ms(number + 1) <= time_ms) return number + 1;
  return number;
}

std::int64_t Orbit::orbit_begin_ms(std::int64_t orbit_number) const {
  return elements_.launch_ms + std::llround(static_cast<double>(orbit_number - 1) * period_s() * 1000);
}

double greenwich_sidereal_angle_rad(std::int64_t time_ms) {
  const double days = julian_days(time_ms);
  const double centuries = days / 36525;
  const double degrees = 280.46061837 + 360.98564736629 * days + 0.000387933 * centuries * centuries;
  return turn_of(degrees * kDegree);
}

Vector3 sun_direction(std::int64_t time_ms) {
  const double days = julian_days(time_ms);
  const double anomaly = (357.528 + 0.9856003 * days) * kDegree;
  const double longitude = mean_sun_rad(days) + (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * kDegree;
  const double obliquity = (23.439 - 0.0000004 * days) * kDegree;
  const Vector3 among_stars{std::cos(longitude), std::cos(obliquity) * std::sin(longitude),
                            std::sin(obliquity) * std::sin(longitude)};
  return earth_fixed(among_stars, greenwich_sidereal_angle_rad(time_ms));
}

}  // namespace thin
