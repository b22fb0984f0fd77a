#include "libemap/rendering/level_of_detail.h"

#include <gtest/gtest.h>

#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

TEST(LevelOfDetailTest, ALevelHasAQuarterOfTheSamplesOnTheSameSurface) {
  const Mesh sphere = test::sphere(60);
  const ElevationMaps maps = test::sampled(sphere, 0.5).maps;
  const auto samples = [](const ElevationMaps& all) {
    std::size_t count = 0;
    for (const ElevationPatch& patch : all.patches) count += std::count(patch.mask.begin(), patch.mask.end(), 1);
    return static_cast<double>(count);
  };
  for (int level = 1; level <= 2; ++level) {
    const ElevationMaps coarser = coarser_maps(maps, level);
    EXPECT_DOUBLE_EQ(coarser.spacing, maps.spacing * (1 << level));
    EXPECT_NEAR(samples(maps) / samples(coarser), 1 << (2 * level), 0.05 * (1 << (2 * level)));
    for (const ElevationPatch& patch : coarser.patches)
      for (std::uint32_t row = 0; row < patch.rows; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column)
          if (patch.mask[row * patch.columns + column]) {
            EXPECT_NEAR(sample_position(patch, coarser.spacing, row, column).norm(), 1, 0.01);
          }
  }
}

TEST(LevelOfDetailTest, LevelZeroIsWhatWasGiven) {
  const ElevationMaps maps = test::sampled(test::waves(10), 1).maps;
  const ElevationMaps same = coarser_maps(maps, 0);
  EXPECT_EQ(same.spacing, maps.spacing);
  EXPECT_EQ(same.patches[0].elevation, maps.patches[0].elevation);
}

TEST(LevelOfDetailTest, SamplesAreAtMostAPixelApart) {
  Camera camera;
  for (const double distance : {0.8, 2.0, 5.0, 20.0})
    for (const int height : {64, 512, 2048}) {
      camera.distance = distance;
      const double spacing = 1.0 / 3000;
      const int level = level_for_view(spacing, camera, height);
      const double pixels = height / (2 * std::tan(std::numbers::pi / 12)) / depth_range(camera).nearest;
      if (level > 0) {
        EXPECT_LE(spacing * (1 << level) * pixels, 1);
      }
      EXPECT_GT(spacing * (2 << level) * pixels, 1);
    }
}

}  // namespace
}  // namespace emap
