#include "libthin/estimation/gme_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

TEST(GmeGrid, HasTheVerticesOfItsLevel) {
  EXPECT_EQ(gme_grid(0).size(), 12U);
  EXPECT_EQ(gme_grid(1).size(), 42U);
  EXPECT_EQ(gme_grid(6).size(), 40962U);
  EXPECT_EQ(gme_vertex_count(6), 40962U);
}

TEST(GmeGrid, HasTheFourPicturesOfTheThesis) {  // figure 6.5: 12, 162, 642, 2562 points
  for (const auto& [level, count] : {std::pair(0, 12U), {2, 162U}, {3, 642U}, {4, 2562U}})
    EXPECT_EQ(gme_grid(level).size(), count);
}

TEST(GmeGrid, LiesOnTheEllipsoidAndHoldsThePoles) {
  const std::vector<Vector3> grid = gme_grid(4);
  for (const Vector3& vertex : grid) EXPECT_NEAR(geodetic(vertex).height_km, 0, 1e-6);
  EXPECT_NEAR(geodetic(grid[0]).latitude_deg, 90, 1e-9);
  EXPECT_NEAR(geodetic(grid[1]).latitude_deg, -90, 1e-9);
}

TEST(GmeGrid, CoarserLevelsAreItsPrefix) {
  const std::vector<Vector3> coarse = gme_grid(2), fine = gme_grid(3);
  for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_EQ(coarse[i], fine[i]);
}

TEST(GmeGrid, IsNearlyUniform) {
  const std::vector<Vector3> grid = gme_grid(5);
  const KdTree tree({reinterpret_cast<const double*>(grid.data()), grid.size() * 3}, 3);
  const double mean_area = 4 * std::numbers::pi * kEarthRadiusKm * kEarthRadiusKm / static_cast<double>(grid.size());
  const double spacing_km = std::sqrt(mean_area * 2 / std::sqrt(3));  // of a hexagonal lattice of this density
  std::vector<Neighbour> found;
  for (const Vector3& vertex : grid) {
    tree.nearest(std::array{vertex.x, vertex.y, vertex.z}, 2, found);
    const double nearest_km = std::sqrt(found[1].distance_squared);
    EXPECT_GT(nearest_km, 0.8 * spacing_km);  // no two coincide, and no hole
    EXPECT_LT(nearest_km, 1.2 * spacing_km);
  }
}

}  // namespace
}  // namespace thin
