#pragma once

// Slow and obvious counterparts of orbit.h and scan_geometry.h: motion under gravity integrated step by step, and a
// view followed down its ray until it meets the ground.

#include <cmath>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/orbit.h"

namespace thin::test {

inline double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector3 plus(const Vector3& a, double s, const Vector3& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vector3 unit(const Vector3& a) {
  return plus({}, 1 / std::sqrt(dot(a, a)), a);
}

// Among the stars: position in km, velocity in km/s.
struct Motion {
  Vector3 position, velocity;
};

// The Earth's attraction with its oblateness, from the gradient of the potential mu/r (1 - J2 (R/r)^2 P2(sin
// latitude)).
inline Vector3 attraction(const Vector3& p) {
  constexpr double kMu = 398600.4418, kJ2 = 1.08262668e-3, kRadius = 6378.137;
  const double r2 = dot(p, p);
  const double r = std::sqrt(r2);
  const double oblate = 1.5 * kJ2 * kRadius * kRadius / r2;
  const double sine2 = p.z * p.z / r2;
  const double plain = -kMu / (r2 * r);
  return {plain * p.x * (1 + oblate * (1 - 5 * sine2)), plain * p.y * (1 + oblate * (1 - 5 * sine2)),
          plain * p.z * (1 + oblate * (3 - 5 * sine2))};
}

// Runge and Kutta's fourth order.
inline Motion integrate(Motion m, double duration_s, double step_s) {
  const auto rate = [](const Motion& at) { return Motion{at.velocity, attraction(at.position)}; };
  const auto moved = [](const Motion& at, double s, const Motion& by) {
    return Motion{plus(at.position, s, by.position), plus(at.velocity, s, by.velocity)};
  };
  for (double t = 0; t < duration_s - step_s / 2; t += step_s) {
    const Motion a = rate(m), b = rate(moved(m, step_s / 2, a)), c = rate(moved(m, step_s / 2, b)),
                 d = rate(moved(m, step_s, c));
    m = moved(moved(moved(moved(m, step_s / 6, a), step_s / 3, b), step_s / 3, c), step_s / 6, d);
  }
  return m;
}

// The satellite's motion as the stars see it.
inline Motion among_stars(const Orbit::State& state, std::int64_t time_ms) {
  constexpr double kEarthRate = 7.292115855e-5;
  const double angle = greenwich_sidereal_angle_rad(time_ms);
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](const Vector3& v) { return Vector3{c * v.x - s * v.y, s * v.x + c * v.y, v.z}; };
  const Vector3 p = state.position_km;
  return {turned(p), turned(plus(state.velocity_km_per_s, kEarthRate, {-p.y, p.x, 0}))};
}

struct SlowView {
  double latitude_deg, longitude_deg, zenith_deg, azimuth_deg;
};

// Everything by differences of positions: no direction comes from a formula for it.
inline SlowView slow_look(const Orbit& orbit, std::int64_t time_ms, double scan_angle_deg) {
  const double degree = std::acos(-1.0) / 180;
  const Vector3 satellite = orbit.at(time_ms).position_km;
  const auto ground = [](const GeodeticPosition& g) { return geocentric_km(g.latitude_deg, g.longitude_deg); };
  const Vector3 down = unit(plus(ground(geodetic(satellite)), -1, satellite));
  const Vector3 forward = plus(orbit.at(time_ms + 50).position_km, -1, orbit.at(time_ms - 50).position_km);
  const Vector3 right = unit(cross(down, forward));
  const Vector3 ray = plus(plus({}, std::cos(scan_angle_deg * degree), down), std::sin(scan_angle_deg * degree), right);

  double above_km = 0, below_km = 0;
  while (geodetic(plus(satellite, below_km, ray)).height_km > 0) below_km += 10;
  while (below_km - above_km > 1e-7) {
    const double middle_km = (above_km + below_km) / 2;
    (geodetic(plus(satellite, middle_km, ray)).height_km > 0 ? above_km : below_km) = middle_km;
  }
  const GeodeticPosition seen = geodetic(plus(satellite, below_km, ray));

  const auto height_km = [&](const Vector3& p) { return geodetic(p).height_km; };
  const Vector3 p = ground(seen);
  const double e = 0.5;
  const Vector3 up = unit({height_km(plus(p, e, {1, 0, 0})) - height_km(plus(p, -e, {1, 0, 0})),
                           height_km(plus(p, e, {0, 1, 0})) - height_km(plus(p, -e, {0, 1, 0})),
                           height_km(plus(p, e, {0, 0, 1})) - height_km(plus(p, -e, {0, 0, 1}))});
  const Vector3 north = unit(plus(geocentric_km(seen.latitude_deg + 1e-4, seen.longitude_deg), -1,
                                  geocentric_km(seen.latitude_deg - 1e-4, seen.longitude_deg)));
  const Vector3 east = cross(north, up);
  const Vector3 back = plus({}, -1, ray);
  const double azimuth = std::atan2(dot(back, east), dot(back, north)) / degree;
  return {seen.latitude_deg, seen.longitude_deg, std::acos(dot(up, back)) / degree,
          azimuth < 0 ? azimuth + 360 : azimuth};
}

}  // namespace thin::test
