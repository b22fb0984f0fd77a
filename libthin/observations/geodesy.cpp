#include "libthin/observations/geodesy.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Math.hpp>
#include <cassert>
#include <cmath>

namespace thin {

double normalised_longitude_deg(double longitude_deg) {
  const double normalised = GeographicLib::Math::AngNormalize(longitude_deg);
  return normalised == 180 ? -180 : normalised;
}

Vector3 geocentric_km(double latitude_deg, double longitude_deg) {
  assert(latitude_deg >= -90 && latitude_deg <= 90 && std::isfinite(longitude_deg));
  Vector3 metres;
  GeographicLib::Geocentric::WGS84().Forward(latitude_deg, normalised_longitude_deg(longitude_deg), 0.0, metres.x,
                                             metres.y, metres.z);
  return {metres.x / 1000, metres.y / 1000, metres.z / 1000};
}

GeodeticPosition geodetic(const Vector3& position_km) {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double height_m = 0;
  GeographicLib::Geocentric::WGS84().Reverse(position_km.x * 1000, position_km.y * 1000, position_km.z * 1000,
                                             latitude_deg, longitude_deg, height_m);
  return {latitude_deg, normalised_longitude_deg(longitude_deg), height_m / 1000};
}

double chord_km(const Vector3& a, const Vector3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

}  // namespace thin
