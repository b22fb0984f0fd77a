#include "libemap/partition/normal_cone.h"

#include <gtest/gtest.h>

#include <random>

namespace emap {
namespace {

// The smallest ball that holds all is that of two or three of them: all are tried.
double best_radius(const std::vector<Eigen::Vector3d>& points) {
  double best = 1e9;
  const auto try_centre = [&](const Eigen::Vector3d& centre) {
    double radius = 0;
    for (const Eigen::Vector3d& point : points) radius = std::max(radius, (point - centre).norm());
    best = std::min(best, radius);
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      try_centre((points[i] + points[j]) / 2);
      for (std::size_t k = 0; k < j; ++k) {
        const Eigen::Vector3d a = points[i] - points[k], b = points[j] - points[k], n = a.cross(b);
        if (n.squaredNorm() < 1e-18) continue;
        try_centre(points[k] + (a.squaredNorm() * b - b.squaredNorm() * a).cross(n) / (2 * n.squaredNorm()));
      }
    }
  return best;
}

TEST(NormalCone, IsTheNarrowest) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Eigen::Vector3d> normals;
    for (int i = 0; i < 14; ++i)
      normals.push_back(
          (Eigen::Vector3d(0, 0, 1.5) + Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized())
              .normalized());
    const NormalCone cone = normal_cone(normals);
    // Unit vectors within an angle a of the axis lie in a ball of radius sin a around its foot.
    const double radius = best_radius(normals);
    EXPECT_NEAR(cone.aperture_cosine, std::sqrt(1 - radius * radius), 1e-6);
    for (const Eigen::Vector3d& n : normals) EXPECT_GE(n.dot(cone.axis), cone.aperture_cosine - 1e-12);
  }
}

TEST(NormalCone, BearsWhatHasNoDirection) {
  EXPECT_EQ(normal_cone({}).aperture_cosine, 1);
  EXPECT_EQ(normal_cone({Eigen::Vector3d::Zero()}).aperture_cosine, 1);
  EXPECT_EQ(normal_cone({Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX()}).axis, Eigen::Vector3d::UnitX());
  EXPECT_LE(normal_cone({Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX()}).aperture_cosine, 0);
}

}  // namespace
}  // namespace emap
