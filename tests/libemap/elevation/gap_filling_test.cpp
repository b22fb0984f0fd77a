#include "libemap/elevation/gap_filling.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/triangle_crossing.h"
#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/model_file.h"
#include "tests/support/sampled_surfaces.h"
#include "tests/support/shared_data.h"

namespace emap {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

Exact::Triangle_3 exact_triangle(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto point = [&](std::uint32_t vertex) {
    const Eigen::Vector3d& p = mesh.positions[vertex];
    return Exact::Point_3(p.x(), p.y(), p.z());
  };
  return {point(triangle[0]), point(triangle[1]), point(triangle[2])};
}

// Whether CGAL's exact intersection of two triangles is more than what they share: nothing, a vertex or an edge.
bool meet_elsewhere(const Mesh& mesh, const std::array<std::uint32_t, 3>& first,
                    const std::array<std::uint32_t, 3>& second) {
  const auto shared = std::count_if(first.begin(), first.end(), [&](std::uint32_t vertex) {
    return std::find(second.begin(), second.end(), vertex) != second.end();
  });
  const auto common = CGAL::intersection(exact_triangle(mesh, first), exact_triangle(mesh, second));
  if (!common) return false;
  if (boost::get<Exact::Point_3>(&*common)) return shared == 0;
  return !(boost::get<Exact::Segment_3>(&*common) && shared == 2);
}

// Pairs of an inserted triangle and any other that cross.
std::size_t crossing_insertions(const Mesh& mesh, std::size_t inserted) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Box> old_boxes, new_boxes;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    CGAL::Bbox_3 box;
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      const Eigen::Vector3d& p = mesh.positions[vertex];
      box += CGAL::Bbox_3(p.x(), p.y(), p.z(), p.x(), p.y(), p.z());
    }
    (i < mesh.triangles.size() - inserted ? old_boxes : new_boxes).emplace_back(box, i);
  }
  std::size_t crossings = 0;
  const auto judge = [&](const Box& a, const Box& b) {
    crossings += meet_elsewhere(mesh, mesh.triangles[a.info()], mesh.triangles[b.info()]);
  };
  CGAL::box_intersection_d(old_boxes.begin(), old_boxes.end(), new_boxes.begin(), new_boxes.end(), judge);
  CGAL::box_self_intersection_d(new_boxes.begin(), new_boxes.end(), judge);
  return crossings;
}

void expect_clean_filling(const Mesh& open, const ClosedMesh& closed) {
  ASSERT_GE(closed.mesh.triangles.size(), open.triangles.size());
  EXPECT_EQ(closed.mesh.positions, open.positions);  // no vertex moved, none added
  EXPECT_TRUE(std::equal(open.triangles.begin(), open.triangles.end(), closed.mesh.triangles.begin()));
  EXPECT_EQ(closed.filling.inserted, closed.mesh.triangles.size() - open.triangles.size());
  EXPECT_EQ(closed.filling.edges_before, boundary_edges(open).size());
  EXPECT_EQ(closed.filling.edges_left, boundary_edges(closed.mesh).size());
  EXPECT_EQ(crossing_insertions(closed.mesh, closed.filling.inserted), 0U);
}

TEST(GapFilling, ClosesSpheresAndTori) {
  for (const Mesh& mesh : {test::sphere(40), test::torus(40)}) {
    const test::SampledMesh sampled = test::sampled(mesh, 1);
    ASSERT_GT(sampled.maps.patches.size(), 1U);
    const Mesh open = canonical_mesh(sampled.maps);
    const ClosedMesh closed = closed_mesh(sampled.maps);
    expect_clean_filling(open, closed);
    EXPECT_LE(closed.filling.edges_left * 50, closed.filling.edges_before);
    EXPECT_LT(test::error_in_diagonals(mesh, closed.mesh), 0.5 * test::error_in_diagonals(mesh, open));
  }
}

TEST(GapFilling, LeavesHolesOfTheSurfaceOpen) {
  const Mesh mesh = test::waves(40);
  const ClosedMesh closed = closed_mesh(test::sampled(mesh, 1).maps);
  EXPECT_GT(closed.filling.edges_left, 100U);
  EXPECT_LT(test::error_in_diagonals(mesh, closed.mesh), 2e-2);
}

TEST(GapFilling, OfNothingIsNothing) {
  EXPECT_EQ(closed_mesh({1, 1, {0, 0, 0}, {}}).filling.inserted, 0U);
  Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(fill_gaps(1, {}, triangle).edges_left, 3U);
}

TEST(GapFilling, LongEdgesBridgeNoWideHoles) {
  Mesh mesh{{{0, 0, 0}, {20, 0, 0}, {10, -5, 0}, {0, 9, 0}, {20, 9, 0}, {10, 14, 0}}, {{1, 0, 2}, {3, 4, 5}}};
  EXPECT_EQ(fill_gaps(1, {}, mesh).inserted, 0U);
  for (Eigen::Vector3d& position : mesh.positions)
    position = Eigen::Vector3d(0.2 * position.x(), 0.3 * position.y(), 0);
  EXPECT_GT(fill_gaps(1, {}, mesh).inserted, 0U);
}

TEST(TrianglesCross, TellsTouchingFromCrossing) {
  const std::vector<Eigen::Vector3d> p = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0},     {0.5, 0.5, -1}, {0.5, 0.5, 1},
                                          {3, 3, 0}, {2, 2, 0}, {0.4, 0.4, 0}, {0, 0, 1},      {-1, -1, 0}};
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {3, 4, 5}));   // through its middle
  EXPECT_FALSE(triangles_cross(p, {0, 1, 2}, {1, 2, 6}));  // side by side
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {1, 2, 7}));   // folded onto it
  EXPECT_FALSE(triangles_cross(p, {0, 1, 2}, {0, 1, 8}));  // upright at an edge
  EXPECT_FALSE(triangles_cross(p, {0, 1, 2}, {0, 8, 9}));  // at a vertex only
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {0, 3, 4}));   // through it, from a vertex
  EXPECT_TRUE(triangles_cross(p, {0, 1, 2}, {2, 0, 1}));   // the same
}

TEST(GapFilling, OfScannedModelsCrossesNothing) {
  THIN_REQUIRE_SHARED_DATA();
  for (const char* name : {"bunny.ply", "screwdriver.ply"}) {
    const Mesh mesh = *read_mesh((thin::test::shared_data() / "models" / name).string());
    const test::SampledMesh sampled = test::sampled(mesh, 2);
    const ClosedMesh closed = closed_mesh(sampled.maps);
    expect_clean_filling(canonical_mesh(sampled.maps), closed);
    EXPECT_LE(closed.filling.edges_left * 8, closed.filling.edges_before);
  }
}

}  // namespace
}  // namespace emap
