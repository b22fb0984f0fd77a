#include "libemap/partition/partitioning.h"

#include <gtest/gtest.h>

#include <map>

#include "libemap/partition/islands.h"
#include "libemap/partition/split_merge.h"
#include "libemap/surface/bounding_box.h"
#include "libemap/surface/model_file.h"
#include "libemap/surface/point_normals.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/partition_oracle.h"
#include "tests/support/shared_data.h"

namespace emap {
namespace {

class PartitioningTest : public testing::TestWithParam<PartitionMethod> {};

TEST_P(PartitioningTest, EveryPatchIsOneConnectedHeightFieldWithinTheAperture) {
  for (const Mesh& mesh : {test::sphere(24), test::torus(24), test::waves(24), test::spiral_ramp(12)}) {
    const thin::Result<Partition> partition = partition_mesh(mesh, {.method = GetParam()});
    ASSERT_TRUE(partition) << partition.error().message;
    test::expect_complete(mesh_graph(mesh, 0), *partition);
    const double diagonal = bounding_box(mesh.positions).diagonal();
    // Overlaps narrower than a cell of the sheet maps may slip through at the rims.
    EXPECT_LE(test::folded_share(mesh, *partition, diagonal / 700, 1e-3 * diagonal), 1e-3);
    for (const Patch& patch : partition->patches) EXPECT_GE(patch.aperture_cosine, std::cos(80.5 * M_PI / 180));
  }
}

TEST_P(PartitioningTest, PatchesAreFew) {
  EXPECT_EQ(partition_mesh(test::waves(30), {.method = GetParam()})->patches.size(), 1U);
  EXPECT_LE(partition_mesh(test::sphere(40), {.method = GetParam()})->patches.size(), 8U);
  // The ramp lies over itself from one turn on: one patch would do for the normals.
  EXPECT_GE(partition_mesh(test::spiral_ramp(12), {.method = GetParam()})->patches.size(), 3U);
  EXPECT_EQ(partition_mesh(test::spiral_ramp(12), {.method = GetParam(), .strict = false})->patches.size(), 1U);
}

TEST_P(PartitioningTest, DoesNotDependOnTheThreads) {
  const Mesh mesh = test::torus(30);
  const Partition all = *partition_mesh(mesh, {.method = GetParam()});
  const thin::ThreadLimit one(1);
  EXPECT_EQ(partition_mesh(mesh, {.method = GetParam()})->patch_of, all.patch_of);
}

TEST_P(PartitioningTest, PointsToo) {
  PointSet points{test::torus(60).positions, {}};
  ensure_normals(points);
  const thin::Result<Partition> partition = partition_points(points, {.method = GetParam()});
  ASSERT_TRUE(partition) << partition.error().message;
  test::expect_complete(point_graph(points, 5, 0), *partition);
  EXPECT_LE(partition->patches.size(), 16U);
}

TEST_P(PartitioningTest, BearsDegenerateMeshes) {
  const Eigen::Vector3d o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const std::map<std::string, Mesh> meshes = {
      {"one triangle", {{o, x, y}, {{0, 1, 2}}}},
      {"duplicate triangles", {{o, x, y}, {{0, 1, 2}, {0, 1, 2}, {2, 1, 0}}}},
      {"duplicate points", {{o, x, y, o, x, y}, {{0, 1, 2}, {3, 4, 5}, {0, 4, 2}}}},
      {"non-manifold edge", {{o, x, y, z, -y}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}}},
      {"a needle", {{o, x, {0.5, 1e-12, 0}, y}, {{0, 1, 2}, {0, 1, 3}}}},
      {"a triangle without area", {{o, x, 2 * x, y}, {{0, 1, 2}, {0, 1, 3}, {1, 1, 3}}}},
      {"a closed tetrahedron", {{o, x, y, z}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}}}};
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    const thin::Result<Partition> partition = partition_mesh(mesh, {.method = GetParam()});
    ASSERT_TRUE(partition) << partition.error().message;
    ElementGraph graph = mesh_graph(mesh, 0);
    add_links(island_links(graph, 64, 8), graph);
    ASSERT_EQ(partition->patch_of.size(), mesh.triangles.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, PartitioningTest,
                         testing::Values(PartitionMethod::gla, PartitionMethod::split_merge));

TEST(Partitioning, SaysWhatCannotBePartitioned) {
  EXPECT_FALSE(partition_mesh({}));
  EXPECT_FALSE(partition_mesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}));
  EXPECT_FALSE(partition_points({}));
  EXPECT_FALSE(partition_points({{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}}, {}}));
  EXPECT_FALSE(
      partition_points({std::vector<Eigen::Vector3d>(9, {1, 1, 1}), std::vector<Eigen::Vector3d>(9, {0, 0, 1})}));
}

TEST(Partitioning, MorePatchesOnDemand) {
  const Mesh mesh = test::sphere(40);
  EXPECT_GE(partition_mesh(mesh, {.least_patches = 20})->patches.size(), 20U);
  EXPECT_LT(partition_mesh(mesh, {.least_patches = 20})->mean_distortion(), partition_mesh(mesh)->mean_distortion());
}

TEST(SplitClusters, AreNarrow) {
  const ElementGraph graph = mesh_graph(test::torus(20), 0);
  const RoughPartition clusters = split_clusters(graph, 30);
  for (std::uint32_t i = 0; i < graph.size(); ++i)
    EXPECT_GE(graph.normals[i].dot(clusters.normals[clusters.patch_of[i]]), std::cos(30 * M_PI / 180) - 1e-9);
}

TEST(Partitioning, OfIgeaIsAsGoodAsTheThesis) {
  THIN_REQUIRE_SHARED_DATA();
  const Mesh mesh = *read_mesh((thin::test::shared_data() / "models" / "igea.ply").string());
  const Partition gla = *partition_mesh(mesh);
  EXPECT_LE(gla.patches.size(), 14U);
  EXPECT_LE(gla.mean_distortion(), 0.36);
  test::expect_complete(mesh_graph(mesh, 0), gla);
  const double diagonal = bounding_box(mesh.positions).diagonal();
  EXPECT_LE(test::folded_share(mesh, gla, diagonal / 600, 1e-3 * diagonal), 1e-4);
  const Partition split_merge = *partition_mesh(mesh, {.method = PartitionMethod::split_merge});
  EXPECT_LE(split_merge.patches.size(), 20U);
}

}  // namespace
}  // namespace emap
