#include "libemap/partition/element_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "libemap/partition/coarsening.h"
#include "libemap/partition/islands.h"
#include "libemap/surface/point_normals.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

TEST(ElementGraph, TrianglesAreNeighboursWhereTheyShareAnEdge) {
  const Mesh mesh = test::torus(7);
  const ElementGraph graph = mesh_graph(mesh, 0);
  for (std::uint32_t a = 0; a < graph.size(); ++a) {
    std::set<std::uint32_t> expected, found;
    for (std::uint32_t b = 0; b < graph.size(); ++b) {
      int shared = 0;
      for (const std::uint32_t vertex : mesh.triangles[a])
        shared += static_cast<int>(std::count(mesh.triangles[b].begin(), mesh.triangles[b].end(), vertex));
      if (a != b && shared == 2) expected.insert(b);
    }
    for (const Adjacency& neighbour : graph.neighbours(a)) found.insert(neighbour.element);
    ASSERT_EQ(found, expected);
  }
}

TEST(ElementGraph, SmoothingBringsNoisyNormalsNearer) {
  Mesh mesh = test::waves(30);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i].z() += 0.004 * static_cast<double>(i * 7919 % 3);
  const auto roughness = [&](int rounds) {
    const ElementGraph graph = mesh_graph(mesh, rounds);
    double sum = 0;
    for (std::uint32_t i = 0; i < graph.size(); ++i)
      for (const Adjacency& neighbour : graph.neighbours(i))
        sum += (graph.normals[i] - graph.normals[neighbour.element]).squaredNorm();
    return sum;
  };
  EXPECT_LT(roughness(3), 0.1 * roughness(0));
}

TEST(ElementGraph, PointsHaveTheAreaOfTheSurface) {
  PointSet points{test::sphere(60).positions, {}};
  std::erase_if(points.positions, [](const Eigen::Vector3d& p) { return std::abs(p.z()) > 0.8; });  // crowded poles
  ensure_normals(points);
  const ElementGraph graph = point_graph(points, 5, 1);
  EXPECT_NEAR(graph.total_area(), 4 * std::numbers::pi * 0.8, 1.5);
  for (std::uint32_t i = 0; i < graph.size(); ++i) EXPECT_GE(graph.neighbours(i).size(), 5U);
}

TEST(Coarsening, GroupsAreConnectedSmallAndComplete) {
  const ElementGraph fine = mesh_graph(test::torus(30), 1);
  const Coarsening coarsening = coarsen(fine, 20, 25);
  EXPECT_GE(coarsening.graph.size() * 20, fine.size());
  EXPECT_LT(coarsening.graph.size() * 6, fine.size());
  EXPECT_NEAR(coarsening.graph.total_area(), fine.total_area(), 1e-9);
  std::vector<int> sizes(coarsening.graph.size(), 0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    ++sizes[coarsening.group_of[i]];
    const std::uint32_t group = coarsening.group_of[i];
    EXPECT_GE(fine.normals[i].dot(coarsening.graph.normals[group]), coarsening.graph.spread_cosines[group]);
  }
  for (const int size : sizes) EXPECT_LE(size, 20);
}

TEST(Islands, AreLinkedToWhatIsNear) {
  Mesh mesh = test::waves(20);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(0.5, 0.5, 0.1), Eigen::Vector3d(0.52, 0.5, 0.1), Eigen::Vector3d(0.5, 0.52, 0.1)})
    mesh.positions.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
  ElementGraph graph = mesh_graph(mesh, 0);
  const std::vector<AdjacentPair> links = island_links(graph, 5, 8);
  ASSERT_EQ(links.size(), 1U);
  EXPECT_EQ(links[0].first, mesh.triangles.size() - 1);
  EXPECT_LT((graph.centres[links[0].second] - graph.centres[links[0].first]).norm(), 0.15);
  add_links(links, graph);
  EXPECT_EQ(graph.neighbours(links[0].first).size(), 1U);
  EXPECT_TRUE(island_links(graph, 5, 8).empty());
}

TEST(ElementGraph, SmoothedNormalsStayAsNearAsTheyAreTold) {
  const ElementGraph before = mesh_graph(test::torus(10), 0);
  ElementGraph free = before, held = before;
  smooth_normals(30, free);
  constexpr double kMost_degrees = 12;
  smooth_normals_within(30, kMost_degrees, held);
  const double least_cosine = std::cos(kMost_degrees * M_PI / 180);
  double least_free = 1, least_held = 1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(held.normals[i].norm(), 1, 1e-12);
    least_free = std::min(least_free, before.normals[i].dot(free.normals[i]));
    least_held = std::min(least_held, before.normals[i].dot(held.normals[i]));
  }
  EXPECT_LT(least_free, least_cosine);
  EXPECT_NEAR(least_held, least_cosine, 1e-9);
}

}  // namespace
}  // namespace emap
