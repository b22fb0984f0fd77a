#include "libemap/surface/triangle_raster.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace emap {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Signed areas, point by point.
bool inside(const Corners& t, double x, double y) {
  const auto area = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  };
  const double ab = area(t[0], t[1]), bc = area(t[1], t[2]), ca = area(t[2], t[0]);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

TEST(TriangleRaster, VisitsThePointsUnderATriangleWithItsHeight) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-6, 6);
  for (int trial = 0; trial < 300; ++trial) {
    Corners corners;
    for (auto& corner : corners) {
      corner.x() = place(random), corner.y() = place(random);
      corner.z() = 2 * corner.x() - 3 * corner.y() + 1;
    }
    std::map<std::pair<int, int>, double> visited;
    rasterise_triangle(corners, [&](std::int32_t x, std::int32_t y, double height) {
      EXPECT_TRUE(visited.emplace(std::pair(x, y), height).second);
    });
    for (int y = -7; y <= 7; ++y)
      for (int x = -7; x <= 7; ++x) {
        ASSERT_EQ(visited.contains({x, y}), inside(corners, x, y)) << x << " " << y;
        if (visited.contains({x, y})) {
          ASSERT_NEAR((visited[{x, y}]), 2 * x - 3 * y + 1, 1e-9);
        }
      }
  }
}

TEST(TriangleRaster, NoPointFallsBetweenTwoTriangles) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> slope(-3, 3);
  for (int trial = 0; trial < 200; ++trial) {
    // The common edge passes through (2, 1), which rounding must not lose.
    const double dx = slope(random), dy = slope(random);
    const Eigen::Vector3d a(2 - dx, 1 - dy, 0), b(2 + dx, 1 + dy, 0), left(2 - 9 * dy, 1 + 9 * dx, 0),
        right(2 + 9 * dy, 1 - 9 * dx, 0);
    int found = 0;
    for (const Corners& corners : {Corners{a, b, left}, Corners{b, a, right}})
      rasterise_triangle(corners, [&](std::int32_t x, std::int32_t y, double) { found += x == 2 && y == 1; });
    EXPECT_GE(found, 1);
  }
}

TEST(TriangleRaster, ATriangleWithoutAreaCoversNothing) {
  int visits = 0;
  rasterise_triangle({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 2, 1), Eigen::Vector3d(4, 4, 0)},
                     [&](std::int32_t, std::int32_t, double) { ++visits; });
  EXPECT_EQ(visits, 0);
}

}  // namespace
}  // namespace emap
