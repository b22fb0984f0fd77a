#include "libemap/elevation/resampling.h"

#include <gtest/gtest.h>

#include <random>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/surface/point_normals.h"
#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

// Where the line through the sample meets the patch, highest, by all its triangles in turn.
double brute_elevation(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const BasePlane& plane,
                       const Eigen::Vector3d& foot) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t triangle : triangles) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    Eigen::Matrix3d system;
    system << mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a], -plane.normal;
    if (std::abs(system.determinant()) < 1e-14) continue;
    const Eigen::Vector3d solution = system.inverse() * (foot - mesh.positions[a]);
    if (solution[0] >= -1e-9 && solution[1] >= -1e-9 && solution[0] + solution[1] <= 1 + 1e-9)
      highest = std::max(highest, solution[2]);
  }
  return highest;
}

TEST(ResampleMesh, HitsTheTrianglesExactly) {
  for (const Mesh& mesh : {test::torus(10), test::sphere(9), test::waves(9)}) {
    const test::SampledMesh sampled = test::sampled(mesh, 0.7);
    const auto triangles = sampled.partition.elements_of_patches();
    for (std::size_t i = 0; i < sampled.maps.patches.size(); ++i) {
      ElevationPatch patch = sampled.maps.patches[i];
      const ElevationPatch original = patch;
      std::fill(patch.elevation.begin(), patch.elevation.end(), 0);
      for (std::uint32_t row = 0; row < patch.rows; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column) {
          const std::size_t place = std::size_t{row} * patch.columns + column;
          const double expected = brute_elevation(mesh, triangles[i], patch.plane,
                                                  sample_position(patch, sampled.maps.spacing, row, column));
          ASSERT_EQ(original.mask[place] == 1, std::isfinite(expected));
          if (original.mask[place]) {
            ASSERT_NEAR(original.elevation[place], expected, 1e-9);
          }
        }
    }
  }
}

TEST(ResampleMesh, HoldsAboutAsManySamplesAsVertices) {
  const Mesh mesh = test::sphere(60);
  const Mesh samples = canonical_mesh(test::sampled(mesh, 1).maps);
  EXPECT_NEAR(static_cast<double>(samples.positions.size()) / static_cast<double>(mesh.positions.size()), 1, 0.03);
}

TEST(ResampleMesh, FollowsTurnedAndMovedPlanes) {
  const Mesh mesh = test::waves(20);
  test::SampledMesh sampled = test::sampled(mesh, 1);
  ASSERT_EQ(sampled.planes.size(), 1U);
  BasePlane& plane = sampled.planes[0];
  plane.normal = (plane.normal + 0.02 * plane.axis_u).normalized();
  plane.axis_u = (plane.axis_u - plane.axis_u.dot(plane.normal) * plane.normal).normalized();
  plane.axis_v = plane.normal.cross(plane.axis_u);
  plane.origin -= 0.3 * sampled.maps.spacing * (plane.axis_u + plane.axis_v);
  const ElevationMaps maps = resample_mesh(mesh, sampled.partition, sampled.planes, sampled.maps.spacing);
  for (const Eigen::Vector3d& position : sample_points(maps).positions)
    EXPECT_LT(test::brute_distance(mesh, position), 1e-9);
}

TEST(ResampleMesh, PatchesBetweenTheSamplesComeBackEmpty) {
  const Mesh mesh{{{0.3, 0.3, 0}, {0.6, 0.3, 0}, {0.3, 0.6, 0}}, {{0, 1, 2}}};
  const Partition partition = *partition_mesh(mesh);
  const std::vector<BasePlane> planes = {BasePlane{}};
  const ElevationMaps maps = resample_mesh(mesh, partition, planes, 1);
  EXPECT_EQ(maps.patches[0].columns, 0U);
  EXPECT_TRUE(maps.patches[0].mask.empty());
  EXPECT_TRUE(canonical_mesh(maps).positions.empty());
}

TEST(ResamplePoints, LieOnTheSphere) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  PointSet points;
  while (points.positions.size() < 6000)
    points.positions.push_back(Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
  ensure_normals(points);
  const Partition partition = *partition_points(points);
  const std::vector<BasePlane> planes = base_planes(points, partition);
  const MlsSurface surface(points.positions);
  const double spacing = spacing_for_resolution(points, partition, planes, 1);
  const PointSet samples = sample_points(resample_points(points, surface, partition, planes, spacing));
  EXPECT_NEAR(static_cast<double>(samples.positions.size()) / 6000, 1, 0.1);
  double sum = 0;
  for (const Eigen::Vector3d& sample : samples.positions) sum += std::pow(sample.norm() - 1, 2);
  // The thesis's randomly sampled sphere (figure 3.13) is met to about 1e-4 diagonals.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(samples.positions.size())) / (2 * std::sqrt(3.0)), 1e-4);
  // And covered: no point is farther from the samples than they are apart.
  double worst = 0;
  const thin::KdTree tree = tree_of(samples.positions);
  std::vector<thin::Neighbour> found;
  for (const Eigen::Vector3d& point : points.positions) {
    tree.nearest({point.data(), 3}, 1, found);
    worst = std::max(worst, std::sqrt(found[0].distance_squared));
  }
  EXPECT_LT(worst, 6 * spacing);
}

}  // namespace
}  // namespace emap
