#pragma once

// What a partition promises, checked the slow way.

#include <map>

#include "libemap/partition/components.h"
#include "libemap/partition/footprints.h"
#include "libemap/partition/partition.h"
#include "libemap/surface/triangle_raster.h"
#include "tests/support/surfaces.h"

namespace emap::test {

// The share of all lines along the patches' normals, through a fine lattice, that meet one patch of the mesh twice at
// heights that differ by more than the tolerance. 0: every patch is a height field.
inline double folded_share(const Mesh& mesh, const Partition& partition, double lattice, double tolerance) {
  std::size_t lines = 0, folded = 0;
  for (const std::vector<std::uint32_t>& elements : partition.elements_of_patches()) {
    const PlaneAxes axes = axes_around(partition.patches[partition.patch_of[elements.front()]].normal);
    std::map<std::pair<int, int>, std::pair<double, double>> heights;
    for (const std::uint32_t element : elements) {
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d& position = mesh.positions[mesh.triangles[element][i]];
        corners[i] = {axes.u.dot(position) / lattice, axes.v.dot(position) / lattice, axes.normal.dot(position)};
      }
      rasterise_triangle(corners, [&](int u, int v, double height) {
        auto& [low, high] = heights.try_emplace({u, v}, height, height).first->second;
        low = std::min(low, height);
        high = std::max(high, height);
      });
    }
    lines += heights.size();
    for (const auto& [place, range] : heights) folded += range.second - range.first > tolerance;
  }
  return static_cast<double>(folded) / static_cast<double>(lines);
}

// Every element in exactly one patch, none empty, counts and areas right, each patch connected.
inline void expect_complete(const ElementGraph& graph, const Partition& partition) {
  ASSERT_EQ(partition.patch_of.size(), graph.size());
  std::vector<std::uint32_t> counts(partition.patches.size(), 0);
  double area = 0;
  for (const std::uint32_t patch : partition.patch_of) {
    ASSERT_LT(patch, partition.patches.size());
    ++counts[patch];
  }
  for (std::size_t patch = 0; patch < counts.size(); ++patch) {
    EXPECT_GT(counts[patch], 0U);
    EXPECT_EQ(counts[patch], partition.patches[patch].element_count);
    EXPECT_NEAR(partition.patches[patch].normal.norm(), 1, 1e-9);
    area += partition.patches[patch].area;
  }
  EXPECT_NEAR(area, graph.total_area(), 1e-9 * graph.total_area());
  EXPECT_EQ(components_of(graph, partition.patch_of).size(), partition.patches.size());
}

}  // namespace emap::test
