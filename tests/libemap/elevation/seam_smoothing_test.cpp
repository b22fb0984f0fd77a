#include "libemap/elevation/seam_smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/resampling.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

Eigen::Vector3d centre(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
}

double seam_length(const Mesh& mesh, const std::vector<std::uint32_t>& patch_of) {
  const TriangleNeighbours neighbours = triangle_neighbours(mesh);
  double length = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t other = neighbours[i][side];
      if (other != kNoTriangle && other > i && patch_of[i] != patch_of[other])
        length += (mesh.positions[mesh.triangles[i][side]] - mesh.positions[mesh.triangles[i][(side + 1) % 3]]).norm();
    }
  return length;
}

// A plain, or a roof with its ridge at x = 1/2, cut there by a seam that wiggles by `wiggle`.
struct Cut {
  Mesh mesh;
  Partition partition;

  Cut(double slope, double wiggle) {
    mesh =
        test::grid_mesh(60, 60, [&](double u, double v) { return Eigen::Vector3d(u, v, -slope * std::abs(u - 0.5)); });
    partition.patches.resize(2);
    partition.patches[0].normal = Eigen::Vector3d(-slope, 0, 1).normalized();
    partition.patches[1].normal = Eigen::Vector3d(slope, 0, 1).normalized();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Eigen::Vector3d at = centre(mesh, i);
      partition.patch_of.push_back(at.x() > 0.5 + wiggle * std::sin(60 * at.y()));
    }
  }
  std::vector<std::uint32_t> smooth() const {
    const double spacing = 1.0 / 40;
    const ElevationMaps maps = resample_mesh(mesh, partition, base_planes(mesh, partition), spacing);
    return smooth_seams(mesh, triangle_neighbours(mesh), partition, maps);
  }
};

TEST(SeamSmoothing, NeighboursShareAnEdge) {
  const Mesh mesh = test::torus(12);
  const TriangleNeighbours neighbours = triangle_neighbours(mesh);
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    const std::set<std::uint32_t> different(neighbours[i].begin(), neighbours[i].end());
    ASSERT_EQ(different.size(), 3U);
    for (const std::uint32_t other : neighbours[i]) {
      ASSERT_NE(other, kNoTriangle);
      const auto& corners = mesh.triangles[other];
      EXPECT_EQ(std::count_if(corners.begin(), corners.end(),
                              [&](std::uint32_t corner) {
                                return std::count(mesh.triangles[i].begin(), mesh.triangles[i].end(), corner) > 0;
                              }),
                2);
    }
  }
}

TEST(SeamSmoothing, WigglesGoAndTheSeamStaysWhereItIs) {
  const Cut plain(0, 0.03);
  const std::vector<std::uint32_t> smooth = plain.smooth();
  EXPECT_LT(seam_length(plain.mesh, smooth), 0.8 * seam_length(plain.mesh, plain.partition.patch_of));
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    if (std::abs(centre(plain.mesh, i).x() - 0.5) > 0.05) {
      EXPECT_EQ(smooth[i], plain.partition.patch_of[i]);
    }
  }
}

TEST(SeamSmoothing, SeamsStayOnCreases) {
  const Cut roof(1.5, 0);
  EXPECT_EQ(roof.smooth(), roof.partition.patch_of);
}

TEST(SeamSmoothing, TheSameForAnyNumberOfThreads) {
  const Cut plain(0, 0.03);
  const std::vector<std::uint32_t> all = plain.smooth();
  const thin::ThreadLimit limit(1);
  EXPECT_EQ(plain.smooth(), all);
}

TEST(SeamSmoothing, VerticesOnSeamsAreThoseOfTwoPatches) {
  const Cut plain(0, 0);
  for (const Eigen::Vector3d& vertex : vertices_on_seams(plain.mesh, plain.partition.patch_of))
    EXPECT_NEAR(vertex.x(), 0.5, 1e-9);
  EXPECT_EQ(vertices_on_seams(plain.mesh, plain.partition.patch_of).size(), 61U);
}

}  // namespace
}  // namespace emap
