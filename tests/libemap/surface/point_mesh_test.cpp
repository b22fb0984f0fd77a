#include "libemap/surface/point_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/point_normals.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

PointSet points_of(const Mesh& mesh) {
  PointSet points{mesh.positions, {}};
  ensure_normals(points);
  return points;
}

TEST(PointMesh, OfATorusIsClosedAndTurnedOutwards) {
  const PointSet points = points_of(test::torus(40));
  const Mesh mesh = mesh_of_points(points);
  EXPECT_EQ(mesh.positions, points.positions);
  EXPECT_TRUE(boundary_edges(mesh).empty());
  // Genus one: twice as many triangles as vertices.
  EXPECT_EQ(mesh.triangles.size(), 2 * mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d normal = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    ASSERT_GT(normal.dot(points.normals[a]), 0);
  }
}

TEST(PointMesh, TheNormalsDecideWhichSideIsOutside) {
  PointSet points = points_of(test::sphere(16));
  for (Eigen::Vector3d& normal : points.normals) normal = -normal;
  const Mesh mesh = mesh_of_points(points);
  ASSERT_FALSE(mesh.triangles.empty());
  for (const auto& [a, b, c] : mesh.triangles)
    ASSERT_LT(
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).dot(mesh.positions[a]), 0);
}

TEST(PointMesh, WideHolesStayOpen) {
  PointSet sphere;  // a spiral, evenly spaced
  for (int i = 0; i < 4000; ++i) {
    const double z = 1 - (2 * i + 1) / 4000.0, azimuth = 2.399963229728653 * i, r = std::sqrt(1 - z * z);
    if (const double x = r * std::cos(azimuth); x <= 0.8) sphere.positions.emplace_back(x, r * std::sin(azimuth), z);
  }
  ensure_normals(sphere);
  const Mesh mesh = mesh_of_points(sphere);
  const std::vector<BoundaryEdge> rim = boundary_edges(mesh);
  EXPECT_GT(rim.size(), 10U);
  for (const BoundaryEdge& edge : rim) ASSERT_GT(mesh.positions[edge.from].x(), 0.6);
}

TEST(PointMesh, PointsOfAPlaneCoverIt) {
  const Mesh plane = test::grid_mesh(12, 12, [](double u, double v) { return Eigen::Vector3d(u, v, 0.25); });
  const Mesh mesh = mesh_of_points(points_of(plane));
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).norm() / 2;
  EXPECT_NEAR(area, 1, 1e-9);
}

TEST(PointMesh, TheOrderOfThePointsIsOfNoMatter) {
  const PointSet points = points_of(test::torus(12));
  PointSet backwards = points;
  std::reverse(backwards.positions.begin(), backwards.positions.end());
  std::reverse(backwards.normals.begin(), backwards.normals.end());
  const auto corners = [](const Mesh& mesh) {
    std::set<std::set<std::array<double, 3>>> triangles;
    for (const auto& triangle : mesh.triangles) {
      std::set<std::array<double, 3>> places;
      for (const std::uint32_t vertex : triangle) {
        const Eigen::Vector3d& p = mesh.positions[vertex];
        places.insert({p.x(), p.y(), p.z()});
      }
      triangles.insert(places);
    }
    return triangles;
  };
  EXPECT_EQ(corners(mesh_of_points(points)), corners(mesh_of_points(backwards)));
}

TEST(PointMesh, PointsAtOnePlaceMakeNoTriangles) {
  PointSet points;
  points.positions.assign(20, {1, 2, 3});
  ensure_normals(points);
  EXPECT_TRUE(mesh_of_points(points).triangles.empty());
}

// What lies where in memory is another matter each time.
TEST(PointMesh, IsTheSameEachTime) {
  for (const Mesh& surface : {test::torus(60), test::sphere(48)}) {
    const PointSet points = points_of(surface);
    const Mesh first = mesh_of_points(points);
    std::vector<std::vector<char>> elsewhere;
    for (std::size_t round = 0; round < 6; ++round) {
      for (std::size_t i = 0; i < 3000; ++i) elsewhere.emplace_back(16 + (i * 7919 * (round + 1)) % 400);
      for (std::size_t i = round; i < elsewhere.size(); i += 3) elsewhere[i] = {};
      ASSERT_EQ(mesh_of_points(points).triangles, first.triangles) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace emap
