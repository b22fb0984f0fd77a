#include "libemap/surface/mesh_repair.h"

#include <gtest/gtest.h>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"
#include "tests/support/random32.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

// Sum of the triangles' scaled normals times a corner: six times the volume inside a closed, outward mesh.
double six_volumes(const Mesh& mesh) {
  double sum = 0;
  for (const auto& triangle : mesh.triangles) sum += scaled_normal(mesh, triangle).dot(mesh.positions[triangle[0]]);
  return sum;
}

TEST(MeshRepair, WeldsASoupToTheMeshItCameFrom) {
  const Mesh mesh = test::torus(12);
  Mesh soup;
  soup.positions.emplace_back(100, 100, 100);  // that no triangle uses
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : triangle) soup.positions.push_back(mesh.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.positions.push_back(mesh.positions[0]);
  soup.triangles.push_back({1, 2, static_cast<std::uint32_t>(soup.positions.size() - 1)});
  soup.positions.back() = soup.positions[2];  // now a line
  const Mesh result = weld_vertices(soup);
  EXPECT_EQ(result.positions.size(), mesh.positions.size());
  ASSERT_EQ(result.triangles.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(result.positions[result.triangles[i][corner]], mesh.positions[mesh.triangles[i][corner]]);
  EXPECT_TRUE(boundary_edges(result).empty());
}

TEST(MeshRepair, TurnsTrianglesAsMostOfThemAre) {
  const Mesh mesh = test::torus(12);
  Mesh mixed = mesh;
  test::Random32 random(5);
  for (auto& triangle : mixed.triangles)
    if (random() % 4 == 0) std::swap(triangle[0], triangle[1]);
  ASSERT_LT(six_volumes(mixed), 0.8 * six_volumes(mesh));
  orient_consistently(mixed);
  EXPECT_NEAR(six_volumes(mixed), six_volumes(mesh), 1e-9 * six_volumes(mesh));
}

TEST(MeshRepair, LeavesAConsistentMeshAsItIs) {
  Mesh mesh = test::torus(8);
  mesh.triangles.push_back(
      {mesh.triangles[0][0], mesh.triangles[0][1], mesh.triangles[20][2]});  // a fin: three at an edge
  const auto before = mesh.triangles;
  orient_consistently(mesh);
  EXPECT_EQ(mesh.triangles, before);
}

}  // namespace
}  // namespace emap
