#pragma once

// Elevation maps without a surface behind them: blobs with holes and islands, smooth elevations.

#include <cmath>
#include <random>
#include <vector>

#include "libemap/coding/plane_coding.h"
#include "libemap/elevation/elevation_map.h"
#include "tests/support/random32.h"

namespace emap::test {

// Union of discs less some others; seldom a rectangle's whole width.
inline std::vector<std::uint8_t> random_mask(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  Random32 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::uint8_t> mask(std::size_t{columns} * rows);
  for (int disc = 0; disc < 12; ++disc) {
    const double x = unit(random) * columns, y = unit(random) * rows;
    const double radius = (disc < 8 ? 0.3 : 0.12) * unit(random) * (columns + rows);
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t c = 0; c < columns; ++c)
        if (std::hypot(c - x, r - y) < radius) mask[std::size_t{r} * columns + c] = disc < 8;
  }
  return mask;
}

inline double smooth_elevation(double x, double y, unsigned seed) {
  return std::sin(3 * x + seed) * std::cos(4 * y - seed) + 0.3 * std::sin(17 * x * y + seed) + 0.5 * x;
}

struct SyntheticMaps {
  StreamFrame frame;
  std::vector<CodedPlane> planes;
  ElevationMaps maps;
};

// Maps of several sizes, among them an empty one and one of a single sample.
inline SyntheticMaps synthetic_maps(unsigned seed, std::uint32_t scale = 1) {
  SyntheticMaps all;
  all.frame.box = {{-1, -2, -3}, {3, 2, 1}};
  all.frame.samples_per_diagonal = 100 * scale;
  all.maps.spacing = all.frame.spacing();
  all.maps.diagonal = all.frame.box.diagonal();
  all.maps.box_minimum = all.frame.box.minimum;
  Random32 random(seed);
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes = {{40, 33}, {1, 1},   {0, 0},
                                                                      {7, 64},  {65, 17}, {30, 30}};
  for (const auto& [base_columns, base_rows] : sizes) {
    const std::uint32_t columns = base_columns * scale, rows = base_rows * scale;
    CodedPlane plane{random() % 1024,
                     random() % 1024,
                     random() % 64,
                     static_cast<std::int32_t>(random() % 80) - 40,
                     static_cast<std::int32_t>(random() % 80) - 40,
                     static_cast<std::int32_t>(random() % 80) - 40,
                     columns,
                     rows};
    ElevationPatch patch;
    patch.plane = base_plane_of(plane, all.frame);
    patch.columns = columns;
    patch.rows = rows;
    patch.mask = columns * rows == 1 ? std::vector<std::uint8_t>{1} : random_mask(columns, rows, seed + columns);
    patch.elevation.resize(patch.mask.size());
    for (std::uint32_t r = 0; r < rows; ++r)
      for (std::uint32_t c = 0; c < columns; ++c) {
        const std::size_t i = std::size_t{r} * columns + c;
        if (patch.mask[i]) patch.elevation[i] = 0.3 * smooth_elevation(c * 0.02 / scale, r * 0.02 / scale, seed);
      }
    all.planes.push_back(plane);
    all.maps.patches.push_back(std::move(patch));
  }
  return all;
}

}  // namespace emap::test
