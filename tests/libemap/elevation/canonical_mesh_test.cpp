#include "libemap/elevation/canonical_mesh.h"

#include <gtest/gtest.h>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"

namespace emap {
namespace {

// One patch over the xy-plane; `rows` of characters: '.' for no sample, digits for elevations.
ElevationMaps maps_of(const std::vector<std::string>& rows) {
  ElevationPatch patch;
  patch.rows = static_cast<std::uint32_t>(rows.size());
  patch.columns = static_cast<std::uint32_t>(rows[0].size());
  for (const std::string& row : rows)
    for (const char c : row) {
      patch.mask.push_back(c != '.');
      patch.elevation.push_back(c == '.' ? 0 : (c - '0') * 0.1);
    }
  return {1, 10, {0, 0, 0}, {patch}};
}

TEST(CanonicalMesh, MakesTwoTrianglesOfFourSamplesAndOneOfThree) {
  EXPECT_EQ(canonical_mesh(maps_of({"00", "00"})).triangles.size(), 2U);
  for (const auto& rows : {std::vector<std::string>{".0", "00"}, {"0.", "00"}, {"00", ".0"}, {"00", "0."}}) {
    const Mesh mesh = canonical_mesh(maps_of(rows));
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_GT(scaled_normal(mesh, mesh.triangles[0]).z(), 0);
  }
  EXPECT_TRUE(canonical_mesh(maps_of({"0.", ".0"})).triangles.empty());
  EXPECT_EQ(canonical_mesh(maps_of({"0.", ".0"})).positions.size(), 2U);
}

TEST(CanonicalMesh, CutsAlongTheShorterDiagonal) {
  const auto has_edge = [](const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
    for (const EdgePair& pair : edge_pairs(mesh))
      if (pair.vertex == a && pair.other_vertex == b) return true;
    return false;
  };
  EXPECT_TRUE(has_edge(canonical_mesh(maps_of({"09", "99"})), 1, 2));
  EXPECT_TRUE(has_edge(canonical_mesh(maps_of({"90", "99"})), 0, 3));
}

TEST(CanonicalMesh, LeavesOutCliffs) {
  ElevationMaps maps = maps_of({"0000", "0000"});
  for (const std::size_t place : {2, 3, 6, 7}) maps.patches[0].elevation[place] = 50;
  EXPECT_EQ(canonical_mesh(maps).triangles.size(), 4U);
  EXPECT_EQ(canonical_mesh(maps, {.steepest_degrees = 89.9}).triangles.size(), 6U);
}

TEST(CanonicalMesh, PlacesSamplesAsTheHeaderSays) {
  ElevationMaps maps = maps_of({"12", "34"});
  maps.spacing = 0.5;
  maps.patches[0].plane = {{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  const Mesh mesh = canonical_mesh(maps);
  EXPECT_NEAR((mesh.positions[3] - Eigen::Vector3d(1.4, 2.5, 3.5)).norm(), 0, 1e-12);
  EXPECT_EQ(sample_points(maps).positions, mesh.positions);
  EXPECT_EQ(patches_of_samples(maps), std::vector<std::uint32_t>(4, 0));
}

TEST(SamplePoints, HaveTheNormalsOfARamp) {
  const PointSet points = sample_points(maps_of({"0246", "0246", ".246"}));
  for (const Eigen::Vector3d& normal : points.normals)
    EXPECT_NEAR((normal - Eigen::Vector3d(-0.2, 0, 1).normalized()).norm(), 0, 1e-9);
}

TEST(CanonicalMesh, OfNothingIsEmpty) {
  EXPECT_TRUE(canonical_mesh({}).positions.empty());
  EXPECT_TRUE(canonical_mesh({1, 1, {0, 0, 0}, {ElevationPatch{}}}).positions.empty());
}

}  // namespace
}  // namespace emap
