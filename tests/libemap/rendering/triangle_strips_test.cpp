#include "libemap/rendering/triangle_strips.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>

#include "libemap/elevation/grid_triangles.h"
#include "tests/support/random32.h"

namespace emap {
namespace {

using Corners = std::array<std::size_t, 3>;

Corners sorted(Corners corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

ElevationPatch random_patch(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  test::Random32 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  ElevationPatch patch;
  patch.columns = columns;
  patch.rows = rows;
  for (std::uint32_t i = 0; i < columns * rows; ++i) {
    patch.mask.push_back(unit(random) < 0.8);
    patch.elevation.push_back(patch.mask.back() ? unit(random) : 0);
  }
  return patch;
}

// Against the triangles of the canonical mesh, one by one.
TEST(TriangleStripsTest, AStripHasTheCanonicalTriangles) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  for (const double steepest : {1e9, 0.7}) {
    const ElevationPatch patch = random_patch(70, 20, seed);
    std::set<Corners> expected;
    visit_grid_triangles(patch, [&](const GridTriangle& triangle) {
      if (slope_of(patch, triangle, 1) <= steepest) expected.insert(sorted(triangle));
    });
    std::vector<std::uint16_t> strip;
    append_strip(
        patch, 1, steepest, {0, 69, 0, 19},
        [](std::uint32_t row, std::uint32_t column) { return static_cast<std::uint16_t>(row * 70 + column); }, strip);
    std::multiset<Corners> drawn;
    for (std::size_t i = 2; i < strip.size(); ++i)
      if (strip[i] != strip[i - 1] && strip[i] != strip[i - 2] && strip[i - 1] != strip[i - 2])
        drawn.insert(sorted({strip[i], strip[i - 1], strip[i - 2]}));
    EXPECT_EQ(std::multiset<Corners>(expected.begin(), expected.end()), drawn);
    EXPECT_GT(drawn.size(), 100U);
  }
}

TEST(TriangleStripsTest, AFullMapTakesAboutTwoIndicesToASquare) {
  ElevationPatch patch;
  patch.columns = patch.rows = 65;
  patch.mask.assign(65 * 65, 1);
  patch.elevation.assign(65 * 65, 0);
  std::vector<std::uint16_t> strip;
  append_strip(
      patch, 1, 10, {0, 64, 0, 64},
      [](std::uint32_t row, std::uint32_t column) { return static_cast<std::uint16_t>(row * 65 + column); }, strip);
  EXPECT_LT(strip.size(), 64 * 64 * 2.2);
}

TEST(TriangleStripsTest, OnlyTheSquaresAskedForAreDrawn) {
  const ElevationPatch patch = random_patch(9, 9, 3);
  std::vector<std::uint16_t> strip;
  append_strip(
      patch, 1, 1e9, {2, 5, 3, 6},
      [](std::uint32_t row, std::uint32_t column) {
        EXPECT_TRUE(row >= 3 && row <= 6 && column >= 2 && column <= 5);
        return static_cast<std::uint16_t>(row * 9 + column);
      },
      strip);
  EXPECT_FALSE(strip.empty());
}

}  // namespace
}  // namespace emap
