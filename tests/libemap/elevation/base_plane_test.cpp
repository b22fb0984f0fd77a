#include "libemap/elevation/base_plane.h"

#include <gtest/gtest.h>

#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

TEST(BasePlane, IsOrthonormalAndHoldsItsPatch) {
  const Mesh mesh = test::torus(20);
  const Partition partition = *partition_mesh(mesh);
  const std::vector<BasePlane> planes = base_planes(mesh, partition);
  ASSERT_EQ(planes.size(), partition.patches.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const BasePlane& plane = planes[partition.patch_of[i]];
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      const Eigen::Vector3d offset = mesh.positions[vertex] - plane.origin;
      for (const Eigen::Vector3d& axis : {plane.axis_u, plane.axis_v, plane.normal}) EXPECT_GE(axis.dot(offset), -1e-9);
    }
  }
  for (const BasePlane& plane : planes) {
    EXPECT_NEAR((plane.axis_u.cross(plane.axis_v) - plane.normal).norm(), 0, 1e-12);
    EXPECT_NEAR(plane.axis_u.norm(), 1, 1e-12);
  }
}

TEST(BasePlane, HasTheLeastRectangle) {
  // A 3 by 1 rectangle, turned by 30 degrees within the plane.
  const Eigen::Vector3d along(std::cos(M_PI / 6), std::sin(M_PI / 6), 0), across(-along.y(), along.x(), 0);
  const Mesh mesh =
      test::grid_mesh(6, 2, [&](double u, double v) { return Eigen::Vector3d(3 * u * along + v * across); });
  const Partition partition = *partition_mesh(mesh);
  ASSERT_EQ(partition.patches.size(), 1U);
  const BasePlane plane = base_planes(mesh, partition)[0];
  EXPECT_NEAR(std::max(std::abs(plane.axis_u.dot(along)), std::abs(plane.axis_v.dot(along))), 1, 1e-9);
}

TEST(BasePlane, OfANormalDependsOnItAlone) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, -2, 3).normalized();
  EXPECT_EQ(plane_with_normal(normal).axis_u, plane_with_normal(normal).axis_u);
  EXPECT_NEAR(plane_with_normal(normal).axis_u.dot(normal), 0, 1e-12);
}

}  // namespace
}  // namespace emap
