#include "libemap/coding/shape_adaptive_wavelet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

// The filters themselves (analysis low-pass and high-pass of the 9/7 pair, for a gain of sqrt 2 at frequency 0),
// applied by convolution with whole-sample symmetric extension: the oracle of the lifting.
std::vector<double> convolved(const std::vector<double>& x) {
  static const std::vector<double> low = {0.852698679008894, 0.377402855612831, -0.110624404418437, -0.023849465019557,
                                          0.037828455507264};
  static const std::vector<double> high = {0.788485616405583, -0.418092273221617, -0.040689417609164,
                                           0.064538882628697};
  const int n = static_cast<int>(x.size());
  const auto at = [&](int i) {
    while (i < 0 || i >= n) i = i < 0 ? -i : 2 * (n - 1) - i;
    return x[i];
  };
  std::vector<double> result;
  for (int i = 0; i < n; ++i) {
    const std::vector<double>& filter = i % 2 == 0 ? low : high;
    double sum = filter[0] * at(i);
    for (int k = 1; k < static_cast<int>(filter.size()); ++k) sum += filter[k] * (at(i - k) + at(i + k));
    result.push_back(sum);
  }
  return result;
}

TEST(ShapeAdaptiveWavelet, LiftingIsTheConvolutionWithTheFilters) {
  for (const std::uint32_t length : {2U, 3U, 8U, 17U, 50U}) {
    std::vector<double> line(length);
    for (std::uint32_t i = 0; i < length; ++i) line[i] = std::sin(0.7 * i) + (i % 3) * 0.2;
    const std::vector<double> expected = convolved(line);
    std::vector<double> found = line;
    shape_adaptive_analysis(length, 1, 1, std::vector<std::uint8_t>(length, 1), found);
    // One row only: the step along columns finds runs of one sample, which it multiplies by sqrt 2.
    for (std::uint32_t i = 0; i < length; ++i)
      EXPECT_NEAR(found[i % 2 == 0 ? i / 2 : (length + 1) / 2 + i / 2] / std::sqrt(2.0), expected[i], 1e-6)
          << length << " " << i;
  }
}

TEST(ShapeAdaptiveWavelet, SynthesisUndoesAnalysisOnAnyMask) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const std::uint32_t columns = 1 + seed * 13 % 70, rows = 1 + seed * 29 % 60;
    const auto mask = test::random_mask(columns, rows, seed);
    std::vector<double> samples(mask.size());
    for (std::size_t i = 0; i < mask.size(); ++i)
      if (mask[i])
        samples[i] = std::sin(0.3 * static_cast<double>(i % columns)) + 0.01 * static_cast<double>(i / columns);
    for (const std::uint32_t levels : {0U, 1U, 4U}) {
      std::vector<double> coefficients = samples;
      shape_adaptive_analysis(columns, rows, levels, mask, coefficients);
      const auto support = shape_adaptive_support(columns, rows, levels, mask);
      EXPECT_EQ(std::accumulate(support.begin(), support.end(), 0), std::accumulate(mask.begin(), mask.end(), 0));
      for (std::size_t i = 0; i < mask.size(); ++i) EXPECT_TRUE(support[i] || coefficients[i] == 0);
      shape_adaptive_synthesis(columns, rows, levels, mask, coefficients);
      for (std::size_t i = 0; i < mask.size(); ++i) EXPECT_NEAR(coefficients[i], samples[i], 1e-10);
    }
  }
}

TEST(ShapeAdaptiveWavelet, ConstantsHaveNoHighPassWhateverTheMask) {
  const auto mask = test::random_mask(61, 47, 9);
  std::vector<double> samples(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) samples[i] = mask[i] ? 5.0 : 0.0;
  shape_adaptive_analysis(61, 47, 2, mask, samples);
  for (const Band& band : wavelet_bands(61, 47, 2))
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c)
        EXPECT_TRUE(band.kind == 0 || std::abs(samples[r * 61 + c]) < 1e-9) << r << " " << c;
}

TEST(ShapeAdaptiveWavelet, BandsTileTheMap) {
  for (const std::uint32_t columns : {1U, 2U, 7U, 64U, 65U})
    for (const std::uint32_t rows : {1U, 5U, 33U})
      for (const std::uint32_t levels : {0U, 1U, 3U}) {
        std::vector<int> covered(columns * rows);
        for (const Band& band : wavelet_bands(columns, rows, levels))
          for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
            for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) ++covered[r * columns + c];
        EXPECT_TRUE(std::ranges::all_of(covered, [](int count) { return count == 1; })) << columns << " " << rows;
      }
}

}  // namespace
}  // namespace emap
