#include "libthin/analysis/synthetic_innovations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

void expect_equal(const ObservationSet& a, const ObservationSet& b) {
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.position_km, b.position_km);
  EXPECT_EQ(a.variables, b.variables);
}

TEST(SyntheticInnovations, AreOfTheirArgumentsAlone) {
  expect_equal(orbit_innovations(500), orbit_innovations(500));
  expect_equal(gradient_innovations(500), gradient_innovations(500));
  const ObservationSet spiral = spiral_innovations(2000);
  const ThreadLimit limit(1);
  expect_equal(spiral, spiral_innovations(2000));
  EXPECT_NE(spiral.values, spiral_innovations(2000, 2).values);
  EXPECT_NE(spiral.values, spiral_innovations(2000, 1, false).values);
}

TEST(SyntheticInnovations, OfOrbitsAreOverSeaFromTwoSatellites) {
  const ObservationSet set = orbit_innovations(4000);
  EXPECT_EQ(set.size(), 4000U);
  EXPECT_EQ(set.channels, (std::vector<int>{5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(set.value_kind, ValueKind::innovation);
  EXPECT_EQ(std::set<std::int32_t>(set.platform.begin(), set.platform.end()), (std::set<std::int32_t>{206, 207}));
  EXPECT_TRUE(std::all_of(set.surface.begin(), set.surface.end(), [](Surface s) { return s == Surface::sea; }));
  EXPECT_TRUE(std::is_sorted(set.time_ms.begin(), set.time_ms.end()));
}

TEST(SyntheticInnovations, OfASpiralHaveAsManyNeighboursEverywhere) {
  const ObservationSet set = spiral_innovations(3000);
  const double radius_km = 1000;
  const double expected = 3000 * radius_km * radius_km / (4 * kEarthRadiusKm * kEarthRadiusKm);
  for (std::size_t i = 0; i < set.size(); i += 97) {
    std::size_t near = 0;
    for (const Vector3& other : set.position_km) near += chord_km(set.position_km[i], other) <= radius_km;
    EXPECT_NEAR(static_cast<double>(near), expected, 4) << i;
  }
}

TEST(SyntheticInnovations, OfTheGradientRiseInTheMiddle) {
  const ObservationSet set = gradient_innovations(1000);
  const std::vector<double>& truth = set.variables.at(kSignalFree);
  std::size_t middle = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double east_km = set.longitude_deg[i] * kEarthRadiusKm * std::acos(-1.0) / 180;
    EXPECT_LT(std::abs(east_km), 500);
    EXPECT_NEAR(set.values[i], std::clamp(east_km / 100, -1.0, 1.0), 1e-9);
    EXPECT_EQ(truth[i] != 0, std::abs(set.values[i]) == 1);
    middle += truth[i] == 0;
  }
  EXPECT_NEAR(static_cast<double>(middle), 200, 50);
  const ObservationSet noisy = gradient_innovations(1000, 1, true);
  double squares = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const double east_km = noisy.longitude_deg[i] * kEarthRadiusKm * std::acos(-1.0) / 180;
    squares += std::pow(noisy.values[i] - std::clamp(east_km / 100, -1.0, 1.0), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 1000), 0.25, 0.02);
}

}  // namespace
}  // namespace thin
