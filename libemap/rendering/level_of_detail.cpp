#include "libemap/rendering/level_of_detail.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// The mean of the sample and the eight around it, 4 : 2 : 1; the sample alone at the map's edges.
double smoothed(const ElevationPatch& patch, std::uint32_t row, std::uint32_t column) {
  const std::size_t here = std::size_t{row} * patch.columns + column;
  if (row == 0 || column == 0 || row + 1 == patch.rows || column + 1 == patch.columns) return patch.elevation[here];
  double sum = 0;
  for (int r = -1; r <= 1; ++r)
    for (int c = -1; c <= 1; ++c) {
      const std::size_t there = here + static_cast<std::size_t>(r) * patch.columns + static_cast<std::size_t>(c);
      if (!patch.mask[there]) return patch.elevation[here];
      sum += (2 - std::abs(r)) * (2 - std::abs(c)) * patch.elevation[there];
    }
  return sum / 16;
}

ElevationPatch halved(const ElevationPatch& patch) {
  ElevationPatch half;
  half.plane = patch.plane;
  half.columns = (patch.columns + 1) / 2;
  half.rows = (patch.rows + 1) / 2;
  for (std::uint32_t row = 0; row < half.rows; ++row)
    for (std::uint32_t column = 0; column < half.columns; ++column) {
      const std::uint8_t mask = patch.mask[std::size_t{2 * row} * patch.columns + 2 * column];
      half.mask.push_back(mask);
      half.elevation.push_back(mask ? smoothed(patch, 2 * row, 2 * column) : 0);
    }
  return half;
}

}  // namespace

ElevationMaps coarser_maps(const ElevationMaps& maps, int level) {
  ElevationMaps coarser = maps;
  for (int step = 0; step < level; ++step) {
    coarser.spacing *= 2;
    thin::parallel_ranges(coarser.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) coarser.patches[i] = halved(coarser.patches[i]);
    });
  }
  return coarser;
}

GapFillingOptions filling_at_level(int level) {
  if (level == 0) return {};
  return {.reach = 4, .reach_within = 2, .small_hole_edges = 40, .small_hole_reach = 8};
}

int level_for_view(double spacing_diagonals, const Camera& camera, int picture_height, double pixels) {
  const double half_angle = camera.field_of_view_degrees * std::numbers::pi / 360;
  const double pixels_of_diagonal = picture_height / (2 * std::tan(half_angle)) / depth_range(camera).nearest;
  const double apart = spacing_diagonals * pixels_of_diagonal;
  return std::max(0, static_cast<int>(std::floor(std::log2(pixels / apart))));
}

}  // namespace emap
