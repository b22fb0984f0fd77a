#include "libthin/thinning/latitude_longitude_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "tests/support/random_observations.h"

namespace thin {
namespace {

using Mesh = LatitudeLongitudeMesh;

TEST(LatitudeLongitudeMesh, PlacesLieInTheirBoxes) {
  const ObservationSet set = test::random_observations(2000, 1, 1, {-90, 90, -180, 360});
  for (const Mesh& mesh : {Mesh::regular(7, 13), Mesh::reduced(18, 36, Mesh::Rounding::down),
                           Mesh::reduced(1, 2, Mesh::Rounding::nearest)})
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Mesh::Box box = mesh.box_of(set.latitude_deg[i], set.longitude_deg[i]);
      EXPECT_LE(std::abs(set.latitude_deg[i] - mesh.centre_latitude_deg(box)), mesh.height_deg() / 2 * (1 + 1e-12));
      const double east = std::remainder(set.longitude_deg[i] - mesh.centre_longitude_deg(box), 360);
      EXPECT_LE(std::abs(east), mesh.width_deg(box) / 2 * (1 + 1e-12));
      EXPECT_LT(mesh.number(box), mesh.box_count());
    }
}

TEST(LatitudeLongitudeMesh, NumbersAreTheBoxesOwn) {
  const Mesh mesh = Mesh::reduced(9, 18, Mesh::Rounding::nearest);
  std::set<std::pair<std::int64_t, std::int64_t>> boxes;
  std::set<std::uint64_t> numbers;
  for (double latitude = -89.5; latitude < 90; ++latitude)
    for (double longitude = 0.5; longitude < 360; ++longitude) {
      const Mesh::Box box = mesh.box_of(latitude, longitude);
      boxes.insert({box.band, box.place});
      numbers.insert(mesh.number(box));
    }
  EXPECT_EQ(numbers.size(), boxes.size());
  EXPECT_EQ(numbers.size(), mesh.box_count());
}

TEST(LatitudeLongitudeMesh, EdgesBelongSomewhereInAnyTurn) {
  const Mesh mesh = Mesh::regular(4, 8);
  EXPECT_EQ(mesh.box_of(90, 0).band, 3);
  EXPECT_EQ(mesh.box_of(-90, 0).band, 0);
  for (const double turn : {-360, 0, 360})
    for (const double longitude : {0.0, 44.0, 180.0, 359.9})
      EXPECT_EQ(mesh.number(mesh.box_of(10, longitude + turn)), mesh.number(mesh.box_of(10, longitude)));
  EXPECT_EQ(mesh.box_of(10, -1e-20).place, 7);
}

TEST(LatitudeLongitudeMesh, CountsAreRoundedAsAskedFor) {
  EXPECT_EQ(Mesh::rounded(0.2, Mesh::Rounding::down), 1);
  EXPECT_EQ(Mesh::rounded(7.6, Mesh::Rounding::down), 7);
  EXPECT_EQ(Mesh::rounded(7.6, Mesh::Rounding::nearest), 8);
  EXPECT_EQ(Mesh::rounded(0.1 * 3 * 60, Mesh::Rounding::down), 18);
  EXPECT_EQ(Mesh::rounded(18 - 1e-13, Mesh::Rounding::down), 18);
  EXPECT_EQ(Mesh::reduced(18, 36, Mesh::Rounding::down).box_count(), 404U);  // 2 (35+34+32+29+25+20+15+9+3)
}

}  // namespace
}  // namespace thin
