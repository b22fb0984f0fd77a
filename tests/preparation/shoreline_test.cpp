#include "libthin/preparation/shoreline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "libthin/preparation/surface.h"
#include "tests/support/preparation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

// A star of `points` corners around a centre; longitudes run on over the date line.
std::vector<ShoreEdge> island(double latitude, double longitude, double radius_deg, int points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> reach(0.4 * radius_deg, radius_deg);
  std::vector<std::pair<double, double>> corners;
  for (int p = 0; p < points; ++p) {
    const double angle = 2 * std::numbers::pi * p / points, r = reach(random);
    corners.emplace_back(latitude + r * std::sin(angle), longitude + r * std::cos(angle));
  }
  std::vector<ShoreEdge> edges;
  for (std::size_t p = 0; p < corners.size(); ++p) {
    const auto& [from, to] = std::pair(corners[p], corners[(p + 1) % corners.size()]);
    edges.push_back({from.first, from.second, to.first, to.second});
  }
  return edges;
}

std::vector<ShoreEdge> archipelago() {
  std::vector<ShoreEdge> edges;
  const double centres[][2] = {{10, 3}, {-40, 359}, {60, 180}, {0, 100}, {75, 300}};
  unsigned seed = 1;
  for (const auto& [latitude, longitude] : centres)
    for (const ShoreEdge& edge : island(latitude, longitude, 8, 40, seed++)) edges.push_back(edge);
  return edges;
}

TEST(Shoreline, KnowsLandAsEveryEdgeTogetherDoes) {
  const std::vector<ShoreEdge> edges = archipelago();
  const Shoreline shoreline(edges);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> latitude(-90, 90), longitude(-180, 360), offset(-9, 9);
  std::size_t land = 0;
  for (int i = 0; i < 20'000; ++i) {
    double lat = latitude(random), lon = longitude(random);
    if (i % 2) lat = -40 + offset(random), lon = offset(random);  // an island across the meridian of 0
    const double turned = lon < 0 ? lon + 360 : lon;
    const bool expected = test::is_inside_by_brute_force(edges, lat, turned);
    ASSERT_EQ(shoreline.is_land(lat, lon), expected) << lat << " " << lon;
    land += expected;
  }
  EXPECT_GT(land, 1000U);
}

TEST(Shoreline, LeavesNoGapWhereEdgesMeet) {
  const std::vector<ShoreEdge> edges = archipelago();
  const Shoreline shoreline(edges);
  for (const ShoreEdge& edge : edges) {
    const double below = -89, longitude = edge.from_longitude_deg;
    EXPECT_FALSE(shoreline.is_land(below, longitude)) << longitude;
    EXPECT_FALSE(shoreline.is_land(89, longitude)) << longitude;
  }
}

TEST(Shoreline, KnowsHowNearTheShoreIs) {
  const std::vector<ShoreEdge> edges = archipelago();
  const Shoreline shoreline(edges);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> latitude(-55, 85), longitude(-12, 12), limit(1, 400);
  for (int i = 0; i < 300; ++i) {
    const Vector3 position = geocentric_km(std::min(latitude(random), 89.9), longitude(random));
    const double distance = test::shore_distance_by_brute_force(edges, position, 400);
    const double limit_km = limit(random);
    if (std::abs(distance - limit_km) < 1) continue;  // the oracle's pieces are coarse
    EXPECT_EQ(shoreline.is_near(position, limit_km), distance < limit_km) << distance << " " << limit_km;
  }
}

// Land around the south pole is bounded by one closed line; the pole is inside though no edge goes to it.
TEST(Shoreline, ClosesAroundTheSouthPole) {
  std::vector<ShoreEdge> edges;
  for (int lon = 0; lon < 360; lon += 10)
    edges.push_back(
        {-70.0 - lon % 20, static_cast<double>(lon), -70.0 - (lon + 10) % 20, static_cast<double>(lon + 10)});
  const Shoreline shoreline(edges);
  for (const double lon : {-180.0, 0.0, 5.0, 179.9, 360.0}) {
    EXPECT_TRUE(shoreline.is_land(-90, lon));
    EXPECT_TRUE(shoreline.is_land(-85, lon));
    EXPECT_FALSE(shoreline.is_land(-60, lon));
    EXPECT_FALSE(shoreline.is_land(90, lon));
  }
}

TEST(Shoreline, OfNothingIsSea) {
  const Shoreline shoreline({});
  EXPECT_FALSE(shoreline.is_land(50, 10));
  EXPECT_FALSE(shoreline.is_near(geocentric_km(50, 10), 1000));
}

TEST(Surface, IsFilledWhereUnknownAlone) {
  const std::vector<ShoreEdge> edges = island(0, 180, 8, 40, 3);
  ObservationSet set = test::random_observations(3000, 1, 1);
  for (std::size_t i = 0; i < set.size(); i += 3) set.surface[i] = Surface::ice;
  const Shoreline shoreline(edges);
  EXPECT_EQ(fill_surfaces(set, shoreline, 30), 2000U);
  std::map<Surface, std::size_t> counts;
  for (std::size_t i = 0; i < set.size(); ++i) {
    ++counts[set.surface[i]];
    if (i % 3 == 0) continue;
    const bool near = shoreline.is_near(set.position_km[i], 30);
    const bool land = shoreline.is_land(set.latitude_deg[i], set.longitude_deg[i]);
    EXPECT_EQ(set.surface[i], near ? Surface::coast : land ? Surface::land : Surface::sea);
  }
  EXPECT_EQ(counts[Surface::ice], 1000U);
  EXPECT_GT(counts[Surface::land], 100U);
  EXPECT_GT(counts[Surface::coast], 50U);
}

}  // namespace
}  // namespace thin
