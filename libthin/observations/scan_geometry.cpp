#include "libthin/observations/scan_geometry.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// WGS84 semi-axes.
constexpr double kEquatorialKm = 6378.137;
constexpr double kPolarKm = kEquatorialKm * (1 - 1 / 298.257223563);

double dot(const Vector3& a, const Vector3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// a + s b
Vector3 sum(const Vector3& a, double s, const Vector3& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

Vector3 unit(const Vector3& v) {
  return sum({}, 1 / std::sqrt(dot(v, v)), v);
}

// North, east and up at a place on the ellipsoid.
struct Horizon {
  Vector3 north, east, up;

  Horizon(double latitude_deg, double longitude_deg) {
    const double cp = std::cos(latitude_deg * kDegree), sp = std::sin(latitude_deg * kDegree);
    const double cl = std::cos(longitude_deg * kDegree), sl = std::sin(longitude_deg * kDegree);
    north = {-sp * cl, -sp * sl, cp};
    east = {-sl, cl, 0};
    up = {cp * cl, cp * sl, sp};
  }

  // From the zenith; by the tangent, which keeps small angles exact.
  double zenith_deg(const Vector3& v) const {
    return std::atan2(std::hypot(dot(v, north), dot(v, east)), dot(v, up)) / kDegree;
  }

  double azimuth_deg(const Vector3& v) const {
    const double azimuth = std::atan2(dot(v, east), dot(v, north)) / kDegree;
    return azimuth < 0 ? azimuth + 360 : azimuth;
  }
};

// Distance along the ray to the nearer of its two meetings with the ellipsoid, which is a sphere where z is stretched.
std::optional<double> distance_to_ground_km(const Vector3& from_km, const Vector3& direction) {
  constexpr double kStretch = kEquatorialKm / kPolarKm;
  const Vector3 p{from_km.x, from_km.y, from_km.z * kStretch};
  const Vector3 d{direction.x, direction.y, direction.z * kStretch};
  const double a = dot(d, d);
  const double half_b = dot(p, d);
  const double c = dot(p, p) - kEquatorialKm * kEquatorialKm;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0 || half_b > 0) return std::nullopt;
  return (-half_b - std::sqrt(discriminant)) / a;
}

}  // namespace

double amsua_scan_angle_deg(int field_of_view) {
  assert(field_of_view >= 1 && field_of_view <= kAmsuaFieldsOfView);
  return (field_of_view - 15.5) * (10.0 / 3);
}

std::optional<FieldOfView> look(const Orbit& orbit, std::int64_t time_ms, double scan_angle_deg) {
  const Orbit::State state = orbit.at(time_ms);
  const GeodeticPosition below = geodetic(state.position_km);
  const Vector3 down = sum({}, -1, Horizon(below.latitude_deg, below.longitude_deg).up);
  const Vector3 right = unit(cross(down, state.velocity_km_per_s));

  const double angle = scan_angle_deg * kDegree;
  const Vector3 direction = sum(sum({}, std::cos(angle), down), std::sin(angle), right);
  const auto distance_km = distance_to_ground_km(state.position_km, direction);
  if (!distance_km) return std::nullopt;

  const GeodeticPosition ground = geodetic(sum(state.position_km, *distance_km, direction));
  const Horizon horizon(ground.latitude_deg, ground.longitude_deg);
  const Vector3 to_satellite = sum({}, -1, direction);
  const Vector3 to_sun = sun_direction(time_ms);
  return FieldOfView{time_ms,
                     ground.latitude_deg,
                     ground.longitude_deg,
                     below.height_km,
                     horizon.zenith_deg(to_satellite),
                     horizon.azimuth_deg(to_satellite),
                     horizon.zenith_deg(to_sun),
                     horizon.azimuth_deg(to_sun)};
}

std::array<FieldOfView, kAmsuaFieldsOfView> amsua_scan_line(const Orbit& orbit, std::int64_t begin_ms) {
  std::array<FieldOfView, kAmsuaFieldsOfView> line;
  for (int f = 1; f <= kAmsuaFieldsOfView; ++f) {
    const auto view = look(orbit, begin_ms + (f - 1) * kAmsuaStepMs, amsua_scan_angle_deg(f));
    assert(view);  // from no orbit that Orbit takes does AMSU-A see past the horizon
    line[static_cast<std::size_t>(f - 1)] = *view;
  }
  return line;
}

}  // namespace thin
