#include "libthin/analysis/synthetic_climatology.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/observations/time.h"

namespace thin {
namespace {

const std::int64_t kJuly = from_iso8601("2004-07-21").value();
const std::int64_t kJanuary = from_iso8601("2004-01-21").value();

double channel(const ChannelValues& values, int number) {
  return values[static_cast<std::size_t>(number - 1)];
}

TEST(SyntheticClimatology, LandIsWhereTheContinentsAre) {
  EXPECT_GT(land_fraction(23, 13), 0.99);    // Libya
  EXPECT_GT(land_fraction(55, 90), 0.99);    // Siberia
  EXPECT_GT(land_fraction(-25, 134), 0.99);  // Australia
  EXPECT_GT(land_fraction(-85, 100), 0.99);  // Antarctica
  EXPECT_LT(land_fraction(0, -150), 0.01);   // Pacific
  EXPECT_LT(land_fraction(-40, 80), 0.01);   // Indian Ocean
  EXPECT_LT(land_fraction(40, -40), 0.01);   // Atlantic
  EXPECT_EQ(land_fraction(23, 13), land_fraction(23, 373));
}

TEST(SyntheticClimatology, CoastsAreSmooth) {
  int between = 0;
  for (double longitude = -180; longitude < 180; longitude += 0.1) {
    const double here = land_fraction(30, longitude), next = land_fraction(30, longitude + 0.1);
    EXPECT_LT(std::abs(next - here), 0.06);
    between += here > 0.05 && here < 0.95;
  }
  EXPECT_GT(between, 40);
}

TEST(SyntheticClimatology, OnlyWindowChannelsSeeTheSurface) {
  // Same latitude, land and sea.
  const ChannelValues land = climatology_k(23, 13, kJuly), sea = climatology_k(23, -45, kJuly);
  for (const int window : {1, 2, 3, 15}) EXPECT_GT(channel(land, window) - channel(sea, window), 15) << window;
  for (int sounding = 5; sounding <= 14; ++sounding)
    EXPECT_NEAR(channel(land, sounding), channel(sea, sounding), 1e-9) << sounding;
}

TEST(SyntheticClimatology, TroposphereIsWarmInTheTropicsAndTheTropopauseCold) {
  const ChannelValues tropics = climatology_k(5, -150, kJuly), polar = climatology_k(-65, -150, kJuly);
  for (int troposphere = 3; troposphere <= 7; ++troposphere)
    EXPECT_GT(channel(tropics, troposphere), channel(polar, troposphere)) << troposphere;
  EXPECT_LT(channel(tropics, 9), channel(polar, 9) - 5);
}

TEST(SyntheticClimatology, WarmthFollowsTheSun) {
  EXPECT_GT(channel(climatology_k(45, -150, kJuly), 5), channel(climatology_k(45, -150, kJanuary), 5) + 2);
  EXPECT_LT(channel(climatology_k(-45, -150, kJuly), 5), channel(climatology_k(-45, -150, kJanuary), 5) - 2);
}

TEST(SyntheticClimatology, LimbEffectGrowsFromNadir) {
  for (const double effect : limb_effect_k(0)) EXPECT_EQ(effect, 0);
  EXPECT_NEAR(channel(limb_effect_k(57.6), 5), -7, 1e-9);
  EXPECT_NEAR(channel(limb_effect_k(57.6), 10), 3, 1e-9);
  // In proportion to the longer path: at 60 degrees it is doubled.
  EXPECT_NEAR(channel(limb_effect_k(60), 5), -7 * 1 / (1 / std::cos(57.6 * std::acos(-1) / 180) - 1), 1e-9);
}

}  // namespace
}  // namespace thin
