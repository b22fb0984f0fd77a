#include "libemap/coding/mask_choice.h"

#include <gtest/gtest.h>

#include "libemap/coding/mask_coding.h"
#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
#include "libemap/partition/partitioning.h"
#include "libemap/surface/surface_samples.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

double mask_bits(const ElevationMaps& maps) {
  MaskCoding coding;
  BitCounter counter;
  for (const ElevationPatch& patch : maps.patches) {
    std::vector<std::uint8_t> mask = patch.mask;
    coding.code(counter, patch.columns, patch.rows, mask);
  }
  return counter.bits();
}

std::ptrdiff_t samples_of(const ElevationPatch& patch) {
  return std::count(patch.mask.begin(), patch.mask.end(), 1);
}

double farthest_in_spacings(const Mesh& from, const ElevationMaps& maps) {
  const TriangleTree tree(closed_mesh(maps).mesh);
  double farthest = 0;
  for (const Eigen::Vector3d& position : sample_surface(from, 20000, 1))
    farthest = std::max(farthest, std::sqrt(tree.closest(position).distance_squared));
  return farthest / maps.spacing;
}

struct Sampled {
  Mesh mesh;
  Partition partition;
  ElevationMaps maps;

  Sampled(Mesh given, Partition cut, double spacing) : mesh(std::move(given)), partition(std::move(cut)) {
    maps = resample_mesh(mesh, partition, base_planes(mesh, partition), spacing);
  }
  ElevationMaps chosen(const MaskChoiceOptions& options = {}) const {
    ElevationMaps result = maps;
    choose_cheaper_masks(mesh, partition, TriangleTree(mesh), result, options);
    return result;
  }
};

Sampled sampled_torus() {
  Mesh mesh = test::torus(60);
  Partition partition = *partition_mesh(mesh);
  return {std::move(mesh), std::move(partition), 0.05};
}

TEST(MaskChoice, MasksCostLessAndTheSurfaceStays) {
  const Sampled torus = sampled_torus();
  const ElevationMaps chosen = torus.chosen();
  EXPECT_LT(mask_bits(chosen), 0.9 * mask_bits(torus.maps));
  EXPECT_LT(farthest_in_spacings(torus.mesh, chosen),
            std::max(0.4, 1.2 * farthest_in_spacings(torus.mesh, torus.maps)));
  EXPECT_LE(closed_mesh(chosen).filling.edges_left, closed_mesh(torus.maps).filling.edges_left + 10);
}

TEST(MaskChoice, SamplesLieOnTheMesh) {
  const Sampled torus = sampled_torus();
  const TriangleTree tree(torus.mesh);
  const ElevationMaps chosen = torus.chosen();
  for (const ElevationPatch& patch : chosen.patches)
    for (std::uint32_t row = 0; row < patch.rows; ++row)
      for (std::uint32_t column = 0; column < patch.columns; ++column) {
        const std::size_t place = std::size_t{row} * patch.columns + column;
        if (!patch.mask[place]) {
          EXPECT_EQ(patch.elevation[place], 0);
          continue;
        }
        const Eigen::Vector3d position = sample_position(patch, chosen.spacing, row, column);
        EXPECT_LT(std::sqrt(tree.closest(position).distance_squared), 0.1 * chosen.spacing);
      }
}

TEST(MaskChoice, TheSameForAnyNumberOfThreads) {
  const Sampled torus = sampled_torus();
  const ElevationMaps all = torus.chosen();
  const thin::ThreadLimit limit(1);
  const ElevationMaps one = torus.chosen();
  for (std::size_t i = 0; i < all.patches.size(); ++i) {
    EXPECT_EQ(all.patches[i].mask, one.patches[i].mask);
    EXPECT_EQ(all.patches[i].elevation, one.patches[i].elevation);
  }
}

TEST(MaskChoice, WhereTheSurfaceEndsItsOutlineStays) {
  Mesh mesh = test::grid_mesh(40, 40, [](double u, double v) { return Eigen::Vector3d(u, v, 0); });
  Partition partition{std::vector<std::uint32_t>(mesh.triangles.size(), 0), {Patch()}};
  const Sampled square(std::move(mesh), std::move(partition), 0.03);
  const ElevationMaps chosen = square.chosen();
  EXPECT_LE(samples_of(chosen.patches[0]), samples_of(square.maps.patches[0]));
  EXPECT_LT(farthest_in_spacings(square.mesh, chosen), 1.45);
}

// A plain with a patch of a few samples in its middle, whose vertices are raised.
Sampled plain_with_a_tip(double height) {
  constexpr std::uint32_t kCells = 30;
  Mesh mesh = test::grid_mesh(kCells, kCells, [&](double u, double v) {
    const double from_middle = std::max(std::abs(u - 0.5), std::abs(v - 0.5));
    return Eigen::Vector3d(u, v, height * std::max(0.0, 1 - from_middle * kCells / 2));
  });
  Partition partition{std::vector<std::uint32_t>(mesh.triangles.size(), 0), {Patch(), Patch()}};
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t vertex : mesh.triangles[i]) middle += mesh.positions[vertex] / 3;
    if (std::abs(middle.x() - 0.5) < 1.0 / kCells && std::abs(middle.y() - 0.5) < 1.0 / kCells)
      partition.patch_of[i] = 1;
  }
  return {std::move(mesh), std::move(partition), 1.0 / kCells};
}

TEST(MaskChoice, SmallPatchesGoUnlessTheyAreMissed) {
  const Sampled flat = plain_with_a_tip(0), high = plain_with_a_tip(0.2);
  ASSERT_GT(samples_of(flat.maps.patches[1]), 0);
  EXPECT_EQ(samples_of(flat.chosen().patches[1]), 0);
  EXPECT_LT(farthest_in_spacings(flat.mesh, flat.chosen()), 0.01);
  EXPECT_EQ(samples_of(high.chosen().patches[1]), samples_of(high.maps.patches[1]));
}

}  // namespace
}  // namespace emap
