#include "libthin/observations/geodesy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thin {
namespace {

// The textbook formula for a point on the ellipsoid.
Vector3 slow_geocentric_km(double latitude_deg, double longitude_deg) {
  const double a = 6378.137, f = 1 / 298.257223563, e2 = f * (2 - f);
  const double phi = latitude_deg * std::numbers::pi / 180, lambda = longitude_deg * std::numbers::pi / 180;
  const double n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
  return {n * std::cos(phi) * std::cos(lambda), n * std::cos(phi) * std::sin(lambda), n * (1 - e2) * std::sin(phi)};
}

TEST(Geodesy, PlacesPointsOnTheEllipsoid) {
  for (double latitude = -90; latitude <= 90; latitude += 7.5)
    for (double longitude = -180; longitude < 360; longitude += 13) {
      EXPECT_LT(chord_km(geocentric_km(latitude, longitude), slow_geocentric_km(latitude, longitude)), 1e-8);
      const GeodeticPosition back = geodetic(geocentric_km(latitude, longitude));
      EXPECT_NEAR(back.latitude_deg, latitude, 1e-12);
      EXPECT_NEAR(back.height_km, 0, 1e-8);
      EXPECT_GE(back.longitude_deg, -180);
      EXPECT_LT(back.longitude_deg, 180);
    }
}

TEST(Geodesy, SpellingsOfALongitudeAreOnePlace) {
  EXPECT_EQ(geocentric_km(10, -30), geocentric_km(10, 330));
  EXPECT_EQ(geocentric_km(10, 180), geocentric_km(10, -180));
  EXPECT_EQ(normalised_longitude_deg(359), -1);
  EXPECT_EQ(normalised_longitude_deg(180), -180);
}

TEST(Geodesy, ThePoleIsOnePoint) {
  EXPECT_LT(chord_km(geocentric_km(90, 0), geocentric_km(90, 123)), 1e-9);
  EXPECT_NEAR(geocentric_km(90, 0).z, 6356.7523142, 1e-6);
}

TEST(Geodesy, NeighboursAcrossTheDateLineAreNear) {
  EXPECT_NEAR(chord_km(geocentric_km(0, 179.99), geocentric_km(0, -179.99)), 2.2264, 1e-3);
}

}  // namespace
}  // namespace thin
