#include "libemap/surface/triangle_tree.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/surfaces.h"

namespace emap {
namespace {

TEST(TriangleTree, AgreesWithBruteForce) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-4, 4);
  for (const Mesh& mesh : {test::sphere(9), test::torus(10), test::waves(9), test::spiral_ramp(3)}) {
    const TriangleTree tree(mesh);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d point(place(random), place(random), place(random));
      const TriangleTree::Closest closest = tree.closest(point);
      ASSERT_NEAR(std::sqrt(closest.distance_squared), test::brute_distance(mesh, point), 1e-12);
      ASSERT_NEAR((closest.point - point).squaredNorm(), closest.distance_squared, 1e-12);
    }
  }
}

TEST(TriangleTree, NothingIsNearerThanTheBound) {
  const TriangleTree tree(test::sphere(6));
  EXPECT_EQ(tree.closest({9, 0, 0}, 4).triangle, std::numeric_limits<std::uint32_t>::max());
  EXPECT_EQ(TriangleTree(Mesh{}).closest({0, 0, 0}).triangle, std::numeric_limits<std::uint32_t>::max());
}

TEST(ClosestOnTriangle, BearsNeedlesAndPoints) {
  const Eigen::Vector3d a(0, 0, 0), b(2, 0, 0);
  EXPECT_NEAR((closest_on_triangle({1, 1, 0}, a, b, {1, 0, 0}) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((closest_on_triangle({1, 1, 0}, a, b, {1, 1e-14, 0}) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(closest_on_triangle({1, 1, 0}, b, b, b), b);
}

}  // namespace
}  // namespace emap
