#include "libemap/surface/point_normals.h"

#include <gtest/gtest.h>

#include "libemap/surface/mesh_normals.h"
#include "libemap/surface/point_radii.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

TEST(PointNormals, OrientedNormalsOfATorusAreThoseOfItsMesh) {
  const Mesh torus = test::torus(40);
  PointSet points{torus.positions, {}};
  ensure_normals(points);
  const std::vector<Eigen::Vector3d> expected = vertex_normals(torus);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_GT(points.normals[i].dot(expected[i]), 0.95) << i;
}

TEST(PointNormals, GivenNormalsStay) {
  PointSet points{{{0, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {0, 1, 0}}};
  ensure_normals(points);
  EXPECT_EQ(points.normals[1], Eigen::Vector3d::UnitY());
}

TEST(PointNormals, PointsAtOnePlaceGetSomeNormal) {
  PointSet points{std::vector<Eigen::Vector3d>(20, {1, 2, 3}), {}};
  ensure_normals(points);
  for (const Eigen::Vector3d& normal : points.normals) EXPECT_NEAR(normal.norm(), 1, 1e-12);
}

TEST(PointRadii, OfASquareLatticeAreItsDiagonalsAtMost) {
  PointSet points;
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y) points.positions.emplace_back(x, y, 0);
  ensure_normals(points);
  const std::vector<double> radii = delaunay_radii(points);
  EXPECT_GE(radii[4 * 9 + 4], 1);
  EXPECT_LE(radii[4 * 9 + 4], std::sqrt(2.0) + 1e-9);
}

TEST(PointNeighbours, LeaveThePointItselfOut) {
  const std::vector<Eigen::Vector3d> positions = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  const PointNeighbours neighbours(positions, tree_of(positions), 2);
  for (std::uint32_t point = 0; point < 4; ++point)
    for (const std::uint32_t neighbour : neighbours.of(point)) EXPECT_NE(neighbour, point);
  EXPECT_EQ(PointNeighbours({{1, 1, 1}}, tree_of({{1, 1, 1}}), 5).of(0).size(), 0U);
}

}  // namespace
}  // namespace emap
