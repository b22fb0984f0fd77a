#include "libthin/observations/orbit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "libthin/observations/platforms.h"
#include "libthin/observations/time.h"
#include "tests/support/orbit_oracle.h"

namespace thin {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::int64_t at(const char* iso8601) {
  return from_iso8601(iso8601).value();
}

// The next northward crossing of the equator at or after this time, to the millisecond, by looking.
std::int64_t next_crossing_ms(const Orbit& orbit, std::int64_t time_ms) {
  const auto north = [&](std::int64_t t) { return orbit.at(t).position_km.z >= 0; };
  while (north(time_ms)) time_ms += 10'000;
  while (!north(time_ms)) time_ms += 10'000;
  std::int64_t before_ms = time_ms - 10'000;
  while (time_ms - before_ms > 1) {
    const std::int64_t middle_ms = (time_ms + before_ms) / 2;
    (north(middle_ms) ? time_ms : before_ms) = middle_ms;
  }
  return time_ms;
}

struct Published {
  double period_minutes, inclination_deg;
};
// Two-line elements of the years in service, rounded.
const std::map<std::string, Published> kPublished = {
    {"NOAA-15", {101.0, 98.6}}, {"NOAA-16", {101.9, 98.9}}, {"NOAA-17", {101.1, 98.6}},
    {"NOAA-18", {102.0, 98.9}}, {"NOAA-19", {102.0, 98.9}}, {"Metop-A", {101.3, 98.7}},
    {"Metop-B", {101.3, 98.7}}, {"Metop-C", {101.3, 98.7}}, {"Aqua", {98.8, 98.2}},
};

TEST(Orbit, PeriodAndInclinationAreThePublishedOnes) {
  ASSERT_EQ(known_orbits().size(), kPublished.size());
  for (const OrbitElements& elements : known_orbits()) {
    const Published& published = kPublished.at(platform_name(elements.platform));
    const Orbit orbit(elements);
    EXPECT_NEAR(orbit.period_s() / 60, published.period_minutes, 0.3) << platform_name(elements.platform);
    EXPECT_NEAR(orbit.inclination_deg(), published.inclination_deg, 0.25) << platform_name(elements.platform);
  }
}

TEST(Orbit, PeriodIsTheTimeBetweenNorthwardCrossings) {
  for (const OrbitElements& elements : known_orbits()) {
    const Orbit orbit(elements);
    const std::int64_t first_ms = next_crossing_ms(orbit, at("2010-03-01"));
    const std::int64_t second_ms = next_crossing_ms(orbit, first_ms);
    EXPECT_NEAR(static_cast<double>(second_ms - first_ms), orbit.period_s() * 1000, 2);
  }
}

TEST(Orbit, CrossesTheEquatorAtItsLocalTimeOnAnyDay) {
  for (const OrbitElements& elements : known_orbits())
    for (const char* day : {"2004-01-15", "2004-07-21", "2012-10-03", "2024-04-30"}) {
      const Orbit orbit(elements);
      const std::int64_t crossing_ms = next_crossing_ms(orbit, at(day));
      const double utc_h = static_cast<double>(crossing_ms % 86'400'000) / 3.6e6;
      const double longitude_deg = geodetic(orbit.at(crossing_ms).position_km).longitude_deg;
      const double late_h = std::remainder(utc_h + longitude_deg / 15 - elements.ascending_node_local_time_h, 24);
      EXPECT_NEAR(late_h, 0, 0.01) << platform_name(elements.platform) << " " << day;
    }
}

TEST(Orbit, NodeTurnsWithTheSunUnderIntegratedGravity) {
  const std::int64_t begin_ms = at("2004-07-21");
  for (const OrbitElements& elements : known_orbits()) {
    const Orbit orbit(elements);
    const test::Motion begin = test::among_stars(orbit.at(begin_ms), begin_ms);
    const auto node_deg = [](const test::Motion& m) {
      const Vector3 normal = test::cross(m.position, m.velocity);
      return std::atan2(normal.x, -normal.y) / kDegree;
    };
    // Over whole orbits, so that the node's wobble within each drops out.
    const double orbits = 14;
    const double duration_s = orbits * orbit.period_s();
    const test::Motion end = test::integrate(begin, duration_s, duration_s / 10'000);
    const double per_day = std::remainder(node_deg(end) - node_deg(begin), 360) * 86400 / duration_s;
    EXPECT_NEAR(per_day, 0.9856, 0.012);
    // And our own, by definition.
    const auto end_ms = begin_ms + std::llround(duration_s * 1000);
    const test::Motion ours = test::among_stars(orbit.at(end_ms), end_ms);
    EXPECT_NEAR(std::remainder(node_deg(ours) - node_deg(begin), 360) * 86400 / duration_s, 0.98565, 1e-4);
  }
}

TEST(Orbit, StaysInThePlaneOfIntegratedGravity) {
  // Only the plane: where on it the satellite is depends on J2's ripples of about 10 km in height, which a circle
  // leaves out and an integration from one point turns into a drift along the orbit.
  const std::int64_t begin_ms = at("2004-07-21");
  for (const OrbitElements& elements : known_orbits()) {
    const Orbit orbit(elements);
    test::Motion integrated = test::among_stars(orbit.at(begin_ms), begin_ms);
    for (int minute = 1; minute <= 200; ++minute) {
      integrated = test::integrate(integrated, 60, 5);
      const std::int64_t time_ms = begin_ms + minute * 60'000;
      const test::Motion ours = test::among_stars(orbit.at(time_ms), time_ms);
      const Vector3 normal = test::unit(test::cross(ours.position, ours.velocity));
      EXPECT_LT(std::abs(test::dot(normal, integrated.position)), 3) << minute;
      EXPECT_NEAR(std::hypot(integrated.position.x, integrated.position.y, integrated.position.z),
                  6378.137 + elements.altitude_km, 45);
    }
  }
}

TEST(Orbit, VelocityIsTheChangeOfPosition) {
  const Orbit orbit(*find_orbit("NOAA-16"));
  for (std::int64_t t = at("2004-07-21"); t < at("2004-07-22"); t += 977'000) {
    const Vector3 before = orbit.at(t - 500).position_km, after = orbit.at(t + 500).position_km;
    const Vector3 velocity = orbit.at(t).velocity_km_per_s;
    EXPECT_NEAR(after.x - before.x, velocity.x, 1e-5);
    EXPECT_NEAR(after.y - before.y, velocity.y, 1e-5);
    EXPECT_NEAR(after.z - before.z, velocity.z, 1e-5);
  }
}

TEST(Orbit, GroundTrackReachesTheLatitudeOfTheInclination) {
  for (const OrbitElements& elements : known_orbits()) {
    const Orbit orbit(elements);
    double highest_deg = 0, lowest_deg = 0;
    for (std::int64_t t = at("2004-07-21"); t < at("2004-07-21T04:00Z"); t += 1000) {
      const Vector3 p = orbit.at(t).position_km;
      const double latitude_deg = std::asin(p.z / std::hypot(p.x, p.y, p.z)) / kDegree;
      highest_deg = std::max(highest_deg, latitude_deg);
      lowest_deg = std::min(lowest_deg, latitude_deg);
    }
    EXPECT_NEAR(highest_deg, 180 - orbit.inclination_deg(), 0.01);
    EXPECT_NEAR(lowest_deg, orbit.inclination_deg() - 180, 0.01);
  }
}

TEST(Orbit, NumbersBeginAtNorthwardCrossings) {
  const Orbit orbit(*find_orbit("Metop-A"));
  for (const std::int64_t number : {1, 2, 100, 34292, 99999}) {
    const std::int64_t begin_ms = orbit.orbit_begin_ms(number);
    EXPECT_EQ(orbit.orbit_number(begin_ms), number);
    EXPECT_EQ(orbit.orbit_number(begin_ms - 1), number - 1);
    EXPECT_EQ(orbit.orbit_number(orbit.orbit_begin_ms(number + 1) - 1), number);
    EXPECT_NEAR(orbit.at(begin_ms).position_km.z, 0, 0.01);
    EXPECT_GT(orbit.at(begin_ms).velocity_km_per_s.z, 0);
  }
  // Orbit 34292 was flown on this day.
  EXPECT_NEAR(static_cast<double>(orbit.orbit_number(at("2013-05-29T12:24Z"))), 34292, 60);
  EXPECT_LT(orbit.orbit_number(at("2000-01-01")), 1);
}

TEST(Orbit, SatellitesAreFoundByName) {
  EXPECT_EQ(find_orbit("noaa-15")->platform, 206);
  EXPECT_EQ(find_orbit("METOP-B")->platform, 3);
  EXPECT_FALSE(find_orbit("Terra"));  // a platform with a number, but without AMSU-A
  EXPECT_FALSE(find_orbit("Sputnik"));
}

TEST(SiderealAngle, AgreesWithThePrintedExample) {
  // Vallado, example 3-5.
  EXPECT_NEAR(greenwich_sidereal_angle_rad(at("1992-08-20T12:14Z")) / kDegree, 152.578787886, 1e-4);
  EXPECT_NEAR(greenwich_sidereal_angle_rad(at("2000-01-01T12:00Z")) / kDegree, 280.46061837, 1e-6);
}

TEST(SunDirection, AgreesWithThePrintedExample) {
  // Vallado, example 5-1: 2 April 2006, 0 h: right ascension 11.140899, declination 4.788425 degrees.
  const std::int64_t time_ms = at("2006-04-02");
  const Vector3 sun = sun_direction(time_ms);
  const double right_ascension = std::atan2(sun.y, sun.x) + greenwich_sidereal_angle_rad(time_ms);
  EXPECT_NEAR(std::remainder(right_ascension / kDegree - 11.140899, 360), 0, 0.01);
  EXPECT_NEAR(std::asin(sun.z) / kDegree, 4.788425, 0.01);
  EXPECT_NEAR(std::hypot(sun.x, sun.y, sun.z), 1, 1e-12);
}

TEST(SunDirection, StandsHighestInJune) {
  EXPECT_NEAR(std::asin(sun_direction(at("2004-06-21T00:57Z")).z) / kDegree, 23.44, 0.01);
  EXPECT_NEAR(std::asin(sun_direction(at("2004-03-20T06:49Z")).z) / kDegree, 0, 0.01);
}

}  // namespace
}  // namespace thin
