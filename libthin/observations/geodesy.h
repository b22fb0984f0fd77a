#pragma once

// WGS84, by GeographicLib.

#include "libthin/observations/observation_set.h"

namespace thin {

// Mean radius of the Earth, km, where an area or an angle needs one number (IUGG's R1).
constexpr double kEarthRadiusKm = 6371.0088;

// Position on the ellipsoid, earth-centred, km. Longitude in any turn: -30 and 330 are the same to the last bit.
// REQUIRES: -90 <= latitude_deg <= 90, finite longitude_deg
Vector3 geocentric_km(double latitude_deg, double longitude_deg);

struct GeodeticPosition {
  double latitude_deg;
  double longitude_deg;  // -180 <= longitude_deg < 180
  double height_km;      // above the ellipsoid
};
GeodeticPosition geodetic(const Vector3& position_km);

// Longitude brought to -180 <= x < 180.
double normalised_longitude_deg(double longitude_deg);

// Straight line through the Earth, km.
double chord_km(const Vector3& a, const Vector3& b);

}  // namespace thin
