#include "libemap/surface/mls_surface.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/surfaces.h"

namespace emap {
namespace {

std::vector<Eigen::Vector3d> random_on_sphere(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> points;
  while (points.size() < count)
    points.push_back(Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized());
  return points;
}

TEST(MlsSurface, ProjectsOntoASphere) {
  const MlsSurface surface(random_on_sphere(4000, 1));
  double sum = 0;
  const std::vector<Eigen::Vector3d> directions = random_on_sphere(500, 2);
  for (const Eigen::Vector3d& direction : directions) {
    const MlsProjection projection = surface.project(1.01 * direction);
    sum += std::pow(projection.position.norm() - 1, 2);
    EXPECT_GT(std::abs(projection.normal.dot(projection.position.normalized())), 0.98);
  }
  // Points are about 0.06 apart: a quadratic misses the sphere by a small part of the sagitta, 0.06² / 8.
  EXPECT_LT(std::sqrt(sum / 500), 1e-4);
}

TEST(MlsSurface, ReproducesAPlaneExactly) {
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 12; ++y) points.emplace_back(x, y, 0.5 * x - 0.25 * y);
  const MlsSurface surface(points);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.5, 0.25, 1).normalized();
  const MlsProjection projection = surface.project(Eigen::Vector3d(5.3, 6.1, 0.5 * 5.3 - 0.25 * 6.1) + 0.2 * normal);
  EXPECT_NEAR(normal.dot(projection.position), 0, 1e-9);
  EXPECT_NEAR(std::abs(normal.dot(projection.normal)), 1, 1e-9);
}

TEST(MlsSurface, FarPointsFallBackToTheirNearestInput) {
  const MlsSurface surface(random_on_sphere(2000, 3));
  const MlsProjection projection = surface.project({7, 0, 0});
  EXPECT_FALSE(projection.in_domain);
  EXPECT_NEAR(projection.position.norm(), 1, 1e-2);
  const MlsProjection closest = surface.closest({7, 0, 0});
  EXPECT_NEAR((closest.position - Eigen::Vector3d(1, 0, 0)).norm(), 0, 0.03);
}

TEST(MlsSurface, BearsFewAndEqualPoints) {
  for (const std::vector<Eigen::Vector3d>& points :
       {std::vector<Eigen::Vector3d>{{1, 2, 3}}, std::vector<Eigen::Vector3d>(9, {1, 2, 3}),
        std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}}) {
    const MlsProjection projection = MlsSurface(points).project({1, 1, 1});
    EXPECT_TRUE(projection.position.allFinite());
    EXPECT_NEAR(projection.normal.norm(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace emap
