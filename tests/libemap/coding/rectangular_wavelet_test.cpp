#include "libemap/coding/rectangular_wavelet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "libemap/coding/coefficient_support.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

// The lifting steps as they are written, on one line: the oracle.
std::vector<double> slow_analysis(std::vector<double> x) {
  const int n = static_cast<int>(x.size());
  if (n < 2) return x;
  const auto at = [&](int i) {
    while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
    return x[i];
  };
  for (int i = 1; i < n; i += 2) x[i] -= (9 * (at(i - 1) + at(i + 1)) - at(i - 3) - at(i + 3)) / 16;
  for (int i = 0; i < n; i += 2) x[i] += (9 * (at(i - 1) + at(i + 1)) - at(i - 3) - at(i + 3)) / 32;
  std::vector<double> sorted;
  for (int i = 0; i < n; i += 2) sorted.push_back(x[i]);
  for (int i = 1; i < n; i += 2) sorted.push_back(x[i]);
  return sorted;
}

std::vector<double> test_image(std::uint32_t columns, std::uint32_t rows) {
  std::vector<double> image;
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) image.push_back(test::smooth_elevation(0.1 * c, 0.1 * r, 3));
  return image;
}

TEST(RectangularWavelet, OneLevelIsTheLiftingOfRowsThenColumns) {
  for (const std::uint32_t columns : {1U, 2U, 3U, 8U, 21U})
    for (const std::uint32_t rows : {1U, 2U, 5U, 16U}) {
      const std::vector<double> image = test_image(columns, rows);
      std::vector<std::vector<double>> by_columns(columns);
      for (std::uint32_t r = 0; r < rows; ++r) {
        const auto row = slow_analysis({image.begin() + r * columns, image.begin() + (r + 1) * columns});
        for (std::uint32_t c = 0; c < columns; ++c) by_columns[c].push_back(row[c]);
      }
      std::vector<double> found = image;
      rectangular_analysis(columns, rows, 1, found);
      for (std::uint32_t c = 0; c < columns; ++c) {
        const auto column = slow_analysis(by_columns[c]);
        for (std::uint32_t r = 0; r < rows; ++r) EXPECT_NEAR(found[r * columns + c], column[r], 1e-12);
      }
    }
}

TEST(RectangularWavelet, SynthesisUndoesAnalysis) {
  for (const std::uint32_t columns : {0U, 1U, 2U, 7U, 33U, 64U})
    for (const std::uint32_t rows : {1U, 3U, 40U})
      for (const std::uint32_t levels : {0U, 1U, 3U, 8U}) {
        const std::vector<double> image = test_image(columns, rows);
        std::vector<double> found = image;
        rectangular_analysis(columns, rows, levels, found);
        rectangular_synthesis(columns, rows, levels, found);
        for (std::size_t i = 0; i < image.size(); ++i) EXPECT_NEAR(found[i], image[i], 1e-11);
      }
}

TEST(RectangularWavelet, NormsAreThoseOfWhatOneCoefficientBecomes) {
  constexpr std::uint32_t kSide = 128;
  for (const Band& band : wavelet_bands(kSide, kSide, 3)) {
    std::vector<double> image(kSide * kSide);
    image[(band.row + band.rows / 2) * kSide + band.column + band.columns / 2] = 1;
    rectangular_synthesis(kSide, kSide, 3, image);
    double sum = 0;
    for (const double x : image) sum += x * x;
    EXPECT_NEAR(std::sqrt(sum), synthesis_norm(band), 1e-9) << band.level << " " << band.kind;
  }
}

// The oracle: a coefficient left out must not reach far into the mask.
TEST(CoefficientSupport, WhatIsLeftOutHardlyTouchesTheMask) {
  constexpr std::uint32_t kColumns = 50, kRows = 41;
  const auto mask = test::random_mask(kColumns, kRows, 8);
  const std::uint32_t levels = rectangular_levels(kColumns, kRows);
  const auto support = coefficient_support(kColumns, kRows, levels, mask);
  for (const Band& band : wavelet_bands(kColumns, kRows, levels))
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        EXPECT_TRUE(band.level > 1 || support[r * kColumns + c] == 0);
        EXPECT_TRUE(band.kind != 0 || support[r * kColumns + c] == 1);
        if (band.level == 1 || support[r * kColumns + c]) continue;
        std::vector<double> image(kColumns * kRows);
        image[r * kColumns + c] = 1;
        rectangular_synthesis(kColumns, kRows, levels, image);
        for (std::size_t i = 0; i < image.size(); ++i) EXPECT_TRUE(!mask[i] || std::abs(image[i]) < 0.35);
      }
}

// The oracle: samples counted one by one.
TEST(CoefficientVisibility, IsTheShareOfTheMaskAround) {
  constexpr std::uint32_t kColumns = 53, kRows = 38;
  const auto mask = test::random_mask(kColumns, kRows, 4);
  const auto bands = wavelet_bands(kColumns, kRows, rectangular_levels(kColumns, kRows));
  const auto visibility = coefficient_visibility(kColumns, kRows, bands, mask);
  for (const Band& band : bands)
    for (std::uint32_t r = 0; r < band.rows; ++r)
      for (std::uint32_t c = 0; c < band.columns; ++c) {
        const std::uint32_t side = 1U << band.level;
        const std::uint32_t high = side * (1 + (band.kind >> 1)), wide = side * (1 + (band.kind & 1));
        double seen = 0;
        for (std::uint32_t y = r * side; y < std::min(r * side + high, kRows); ++y)
          for (std::uint32_t x = c * side; x < std::min(c * side + wide, kColumns); ++x) seen += mask[y * kColumns + x];
        const double share = seen / (high * wide);
        constexpr std::array<double, 4> kLimits = {0.1, 0.25, 0.5, 0.75};
        std::uint32_t expected = share == 0 ? 0 : share == 1 ? 6 : 1;
        if (expected == 1)
          for (const double limit : kLimits) expected += share >= limit;
        EXPECT_EQ(visibility[(band.row + r) * kColumns + band.column + c], expected) << band.level << ' ' << band.kind;
      }
}

}  // namespace
}  // namespace emap
