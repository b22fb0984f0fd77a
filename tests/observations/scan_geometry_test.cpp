#include "libthin/observations/scan_geometry.h"

#include <eccodes.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/time.h"
#include "tests/support/orbit_oracle.h"
#include "tests/support/shared_data.h"

namespace thin {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::int64_t at(const char* iso8601) {
  return from_iso8601(iso8601).value();
}

double great_circle_km(const FieldOfView& a, const FieldOfView& b) {
  const double chord =
      chord_km(geocentric_km(a.latitude_deg, a.longitude_deg), geocentric_km(b.latitude_deg, b.longitude_deg));
  return 2 * kEarthRadiusKm * std::asin(chord / 2 / kEarthRadiusKm);
}

double angle_between_deg(double a, double b) {
  return std::abs(std::remainder(a - b, 360));
}

TEST(ScanGeometry, AgreesWithARayFollowedToTheGround) {
  for (const char* satellite : {"NOAA-15", "Metop-A", "Aqua"}) {
    const Orbit orbit(*find_orbit(satellite));
    for (std::int64_t t = at("2004-07-21T22:30Z"); t < at("2004-07-22T00:30Z"); t += 487'000)
      for (const double scan_angle_deg : {-48.333, -20.0, 0.3, 1.667, 35.0, 48.333}) {
        const auto view = look(orbit, t, scan_angle_deg);
        ASSERT_TRUE(view);
        const test::SlowView slow = test::slow_look(orbit, t, scan_angle_deg);
        EXPECT_LT(chord_km(geocentric_km(view->latitude_deg, view->longitude_deg),
                           geocentric_km(slow.latitude_deg, slow.longitude_deg)),
                  0.002);
        EXPECT_NEAR(view->satellite_zenith_deg, slow.zenith_deg, 1e-4);
        EXPECT_LT(angle_between_deg(view->satellite_azimuth_deg, slow.azimuth_deg), 2e-3);
      }
  }
}

TEST(ScanGeometry, ThirtyFieldsOfViewInEqualSteps) {
  EXPECT_NEAR(amsua_scan_angle_deg(1), -(48 + 1.0 / 3), 1e-12);
  EXPECT_NEAR(amsua_scan_angle_deg(30), 48 + 1.0 / 3, 1e-12);
  for (int f = 2; f <= 30; ++f) EXPECT_NEAR(amsua_scan_angle_deg(f) - amsua_scan_angle_deg(f - 1), 10.0 / 3, 1e-12);
}

TEST(ScanGeometry, SwathIsAsPublished) {
  const Orbit orbit(*find_orbit("NOAA-15"));
  for (std::int64_t t = at("2004-07-21T22:30Z"); t < at("2004-07-22T00:30Z"); t += 488'000) {
    const auto line = amsua_scan_line(orbit, t), next = amsua_scan_line(orbit, t + kAmsuaLineMs);
    EXPECT_NEAR(great_circle_km(line[14], next[14]), 52.7, 1.5);
    EXPECT_NEAR(line.front().satellite_zenith_deg, 57.5, 0.7);
    EXPECT_NEAR(line.back().satellite_zenith_deg, 57.5, 0.7);
    EXPECT_NEAR(line[14].satellite_zenith_deg, 1.88, 0.03);
    // Centres of the outermost fields of view, and their outer edges half a beam of 3.3 degrees further out.
    EXPECT_NEAR(great_circle_km(line.front(), line.back()), 2060, 70);
    EXPECT_NEAR(great_circle_km(*look(orbit, t, -49.98), *look(orbit, t, 49.98)), 2190, 60);
    for (int f = 1; f < kAmsuaFieldsOfView; ++f) EXPECT_EQ(line[f].time_ms - line[f - 1].time_ms, kAmsuaStepMs);
  }
}

TEST(ScanGeometry, ScansFromLeftToRightOfTheFlight) {
  for (const OrbitElements& elements : known_orbits()) {
    const Orbit orbit(elements);
    const std::int64_t northward_ms = orbit.orbit_begin_ms(20'000);
    const auto northward = amsua_scan_line(orbit, northward_ms);
    EXPECT_LT(std::remainder(northward.front().longitude_deg - northward.back().longitude_deg, 360), -15);
    const auto southward = amsua_scan_line(orbit, northward_ms + std::llround(orbit.period_s() * 500));
    EXPECT_GT(std::remainder(southward.front().longitude_deg - southward.back().longitude_deg, 360), 15);
    // The satellite stands above the middle of the line: east of field of view 1, west of 30.
    EXPECT_LT(angle_between_deg(northward.front().satellite_azimuth_deg, 90), 30);
    EXPECT_LT(angle_between_deg(northward.back().satellite_azimuth_deg, 270), 30);
  }
}

TEST(ScanGeometry, SeesNothingBeyondTheHorizon) {
  const Orbit orbit(*find_orbit("NOAA-15"));
  const std::int64_t t = at("2004-07-21T22:30Z");
  EXPECT_FALSE(look(orbit, t, 64));
  EXPECT_FALSE(look(orbit, t, 120));  // upwards
  EXPECT_TRUE(look(orbit, t, 60));
}

TEST(ScanGeometry, SunStandsWhereTheClockSays) {
  // By the mean sun of 21 July, 20.4 degrees north, which the true one follows within 1.7 degrees.
  const Orbit orbit(*find_orbit("NOAA-16"));
  const double declination = 20.4 * kDegree;
  for (std::int64_t t = at("2004-07-21"); t < at("2004-07-22"); t += 600'000) {
    const FieldOfView view = *look(orbit, t, 0);
    const double latitude = view.latitude_deg * kDegree;
    const double hour_angle_deg =
        std::remainder(static_cast<double>(t % 86'400'000) / 86'400'000 * 360 - 180 + view.longitude_deg, 360);
    const double cosine = std::sin(latitude) * std::sin(declination) +
                          std::cos(latitude) * std::cos(declination) * std::cos(hour_angle_deg * kDegree);
    EXPECT_NEAR(view.solar_zenith_deg, std::acos(cosine) / kDegree, 2) << to_iso8601(t);
    if (std::abs(std::sin(hour_angle_deg * kDegree)) > 0.1) {
      const bool east = view.solar_azimuth_deg < 180;
      EXPECT_EQ(east, hour_angle_deg < 0) << to_iso8601(t);
    }
  }
}

// One number of every subset of a file's first message.
class RealMessage {
 public:
  explicit RealMessage(const std::string& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    int status = 0;
    handle_ = codes_handle_new_from_file(nullptr, file.get(), PRODUCT_BUFR, &status);
    codes_set_long(handle_, "unpack", 1);
    codes_get_long(handle_, "numberOfSubsets", &count_);
  }
  ~RealMessage() { codes_handle_delete(handle_); }
  RealMessage(const RealMessage&) = delete;
  RealMessage& operator=(const RealMessage&) = delete;

  std::vector<double> get(const std::string& key) const {
    std::vector<double> values(static_cast<std::size_t>(count_));
    std::size_t size = values.size();
    EXPECT_EQ(codes_get_double_array(handle_, ("#1#" + key).c_str(), values.data(), &size), CODES_SUCCESS) << key;
    if (size == 1) values.assign(values.size(), values[0]);
    return values;
  }

 private:
  codes_handle* handle_ = nullptr;
  long count_ = 0;
};

TEST(ScanGeometry, SunIsWhereRealFilesSay) {
  THIN_REQUIRE_SHARED_DATA();
  for (const char* name : {"AMSUA.bufr", "amsu-a-noaa-19.bufr"}) {
    const RealMessage real((test::shared_data() / "observations/amsua" / name).string());
    const auto latitude = real.get("latitude"), longitude = real.get("longitude"),
               zenith = real.get("solarZenithAngle");
    const auto year = real.get("year"), month = real.get("month"), day = real.get("day"), hour = real.get("hour"),
               minute = real.get("minute"), second = real.get("second");
    for (std::size_t i = 0; i < latitude.size(); ++i) {
      const auto whole = [](double x) { return static_cast<int>(std::lround(x)); };
      const auto time_ms =
          to_time_ms({whole(year[i]), whole(month[i]), whole(day[i]), whole(hour[i]), whole(minute[i]), second[i]});
      ASSERT_TRUE(time_ms);
      const double cp = std::cos(latitude[i] * kDegree), sp = std::sin(latitude[i] * kDegree);
      const Vector3 up{cp * std::cos(longitude[i] * kDegree), cp * std::sin(longitude[i] * kDegree), sp};
      EXPECT_NEAR(std::acos(test::dot(up, sun_direction(*time_ms))) / kDegree, zenith[i], 0.05) << name << " " << i;
    }
  }
}

TEST(ScanGeometry, LinesLookLikeRealOnes) {
  THIN_REQUIRE_SHARED_DATA();
  const RealMessage real((test::shared_data() / "observations/amsua/AMSUA.bufr").string());
  const auto latitude = real.get("latitude"), longitude = real.get("longitude"),
             zenith = real.get("satelliteZenithAngle"), azimuth = real.get("bearingOrAzimuth"),
             height = real.get("heightOfStation");
  // The synthetic line northward whose middle is at the latitude of the real one's.
  const Orbit orbit(*find_orbit("Metop-A"));
  std::int64_t t = orbit.orbit_begin_ms(34292);
  while (amsua_scan_line(orbit, t)[14].latitude_deg < latitude[14]) t += 100;
  const auto line = amsua_scan_line(orbit, t);
  EXPECT_NEAR(line[14].satellite_height_km, height[14] / 1000, 6);
  const double turn_deg = longitude[14] - line[14].longitude_deg;
  for (std::size_t f = 0; f < line.size(); ++f) {
    EXPECT_NEAR(line[f].satellite_zenith_deg, zenith[f], 0.1) << f;
    EXPECT_LT(angle_between_deg(line[f].satellite_azimuth_deg, azimuth[f]), 1.0) << f;
    EXPECT_LT(chord_km(geocentric_km(line[f].latitude_deg, line[f].longitude_deg + turn_deg),
                       geocentric_km(latitude[f], longitude[f])),
              20)
        << f;
  }
}

}  // namespace
}  // namespace thin
