#include "libemap/partition/boundary_optimisation.h"

#include <gtest/gtest.h>

#include <random>

#include "libemap/partition/components.h"
#include "libemap/partition/rough_partition.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

// Two patches with a frayed boundary on a flat square.
std::vector<std::uint32_t> frayed_halves(const ElementGraph& graph) {
  std::mt19937 random(3);
  std::vector<std::uint32_t> patch_of(graph.size());
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const double noise = 0.06 * (static_cast<double>(random() % 1000) / 500 - 1);
    patch_of[i] = graph.centres[i].x() + noise < 0.5 ? 0 : 1;
  }
  // Single elements within the other patch would be patches of their own: only connected halves are valid input.
  for (std::uint32_t label : {0U, 1U}) {
    auto parts = components_of(graph, patch_of, label);
    std::sort(parts.begin(), parts.end(),
              [](const auto& a, const auto& b) { return a.elements.size() > b.elements.size(); });
    for (std::size_t i = 1; i < parts.size(); ++i)
      for (const std::uint32_t element : parts[i].elements) patch_of[element] = 1 - label;
  }
  return patch_of;
}

TEST(BoundaryOptimisation, ShortensTheBoundaryByWhatItSays) {
  const Mesh mesh = test::grid_mesh(20, 20, [](double u, double v) { return Eigen::Vector3d(u, v, 0); });
  const ElementGraph graph = mesh_graph(mesh, 0);
  std::vector<std::uint32_t> patch_of = frayed_halves(graph);
  const TriangleFootprints footprints(mesh, {0, 0, 0}, 0.02, 1e-3);
  SheetMap sheets(footprints);
  for (int patch = 0; patch < 2; ++patch) sheets.add_patch(Eigen::Vector3d::UnitZ());
  for (std::uint32_t i = 0; i < graph.size(); ++i) ASSERT_TRUE(sheets.try_add(i, patch_of[i]));
  const double before = boundary_length(graph, patch_of);
  const double gain = optimise_boundaries(graph, 0, sheets, patch_of);
  const double after = boundary_length(graph, patch_of);
  EXPECT_NEAR(before - after, gain, 1e-5);
  EXPECT_LT(after, 0.7 * before);
  EXPECT_EQ(components_of(graph, patch_of).size(), 2U);
}

TEST(BoundaryOptimisation, KeepsPatchesThatNothingShortens) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const ElementGraph graph = mesh_graph(mesh, 0);
  const TriangleFootprints footprints(mesh, {0, 0, 0}, 0.1, 1e-3);
  SheetMap sheets(footprints);
  sheets.add_patch(Eigen::Vector3d::UnitZ());
  std::vector<std::uint32_t> patch_of = {0};
  EXPECT_EQ(optimise_boundaries(graph, 0, sheets, patch_of), 0);
}

}  // namespace
}  // namespace emap
