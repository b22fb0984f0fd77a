#include "libemap/partition/sheet_map.h"

#include <gtest/gtest.h>

#include "tests/support/surfaces.h"

namespace emap {
namespace {

// Two unit squares over each other, `distance` apart.
Mesh two_sheets(double distance) {
  Mesh mesh = test::grid_mesh(10, 10, [](double u, double v) { return Eigen::Vector3d(u, v, 0); });
  const Mesh upper = test::grid_mesh(10, 10, [&](double u, double v) { return Eigen::Vector3d(u, v, distance); });
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), upper.positions.begin(), upper.positions.end());
  for (const auto& [a, b, c] : upper.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  return mesh;
}

TEST(SheetMap, RefusesASecondSheetAndTakesOneWithinTheTolerance) {
  for (const double distance : {0.005, 0.05}) {
    const Mesh mesh = two_sheets(distance);
    const TriangleFootprints footprints(mesh, {0, 0, 0}, 0.03, 0.01);
    SheetMap sheets(footprints);
    sheets.add_patch(Eigen::Vector3d::UnitZ());
    sheets.add_patch(Eigen::Vector3d::UnitZ());
    for (std::uint32_t i = 0; i < 200; ++i) ASSERT_TRUE(sheets.try_add(i, 0));
    for (std::uint32_t i = 200; i < 400; ++i) {
      EXPECT_EQ(sheets.try_add(i, 0), distance < 0.01);
      EXPECT_TRUE(sheets.try_add(i, 1));  // another patch has a map of its own
    }
  }
}

TEST(SheetMap, RefusesACliffAndTakesASlope) {
  // Two halves of a square side by side: level, with a cliff between them, and with a steep ramp.
  const auto mesh_with = [](double rise, bool ramp) {
    return test::grid_mesh(3, 1, [=](double u, double v) {
      const double x = u < 0.5 ? u * 1.35 : 1 - (1 - u) * 1.35;  // the middle third is narrow
      return Eigen::Vector3d(x, v, u < 0.5 ? 0 : rise * (ramp ? 0.2 : 1));
    });
  };
  const auto takes_all = [](const Mesh& mesh, bool without_middle) {
    const TriangleFootprints footprints(mesh, {0, 0, 0}, 0.28, 0.01);
    SheetMap sheets(footprints);
    sheets.add_patch(Eigen::Vector3d::UnitZ());
    bool all = true;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      if (!without_middle || i / 2 != 1) all = sheets.try_add(i, 0) && all;
    return all;
  };
  EXPECT_TRUE(takes_all(mesh_with(1, true), false));
  EXPECT_TRUE(takes_all(mesh_with(0, false), true));
  EXPECT_FALSE(takes_all(mesh_with(5, false), true));
}

TEST(DiscFootprints, FollowTheirPlane) {
  ElementGraph graph;
  graph.centres = {{0.1, 0.2, 0.3}};
  graph.normals = {Eigen::Vector3d(-1, 0, 2).normalized()};
  graph.areas = {1};
  const DiscFootprints footprints(graph, {0, 0, 0}, 0.05, 0.1);
  std::vector<Cell> cells;
  const PlaneAxes axes{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  const std::optional<Slopes> slopes = footprints.append_cells(0, axes, cells);
  ASSERT_TRUE(slopes);
  EXPECT_NEAR(slopes->u, 0.5, 1e-6);
  // A disc of area 1, foreshortened.
  EXPECT_NEAR(static_cast<double>(cells.size()) * 0.05 * 0.05, 2 / std::sqrt(5.0), 0.03);
  for (const Cell& cell : cells) EXPECT_NEAR(cell.height, 0.3 + 0.5 * ((cell.u + 0.5) * 0.05 - 0.1), 1e-5);
}

}  // namespace
}  // namespace emap
