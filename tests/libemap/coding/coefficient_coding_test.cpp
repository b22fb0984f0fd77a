#include "libemap/coding/coefficient_coding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libemap/coding/coefficient_support.h"
#include "libemap/coding/rectangular_wavelet.h"
#include "libemap/coding/sparse_fit.h"
#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

QuantisedMap map_of(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  return quantised_map(columns, rows, test::random_mask(columns, rows, seed));
}

QuantisedMap random_map(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  QuantisedMap map = map_of(columns, rows, seed);
  test::Random32 random(seed);
  for (std::size_t i = 0; i < map.values.size(); ++i) {
    // Mostly zeros, some large ones, now and then the largest there may be.
    const std::uint32_t size = random() % 1000 == 0 ? kValueBits : random() % 9 == 0 ? random() % 12 : random() % 2;
    const auto magnitude = static_cast<std::int32_t>(random() % (1U << size));
    if (map.support[i]) map.values[i] = random() % 2 ? magnitude : -magnitude;
  }
  return map;
}

TEST(CoefficientCoding, ReadsBackWhatWasWritten) {
  CoefficientCoding writing, reading;
  RangeEncoder encoder;
  std::vector<QuantisedMap> maps;
  for (unsigned seed = 1; seed <= 12; ++seed) maps.push_back(random_map(seed * 7 % 50, 1 + seed * 13 % 41, seed));
  for (QuantisedMap& map : maps) {
    const auto before = map.values;
    writing.code(encoder, map);
    EXPECT_EQ(map.values, before);
  }
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (unsigned seed = 1; seed <= 12; ++seed) {
    QuantisedMap read = map_of(seed * 7 % 50, 1 + seed * 13 % 41, seed);
    reading.code(decoder, read);
    EXPECT_EQ(read.values, maps[seed - 1].values) << seed;
  }
  EXPECT_FALSE(decoder.exhausted());
}

TEST(SparseFit, KnownSamplesAreKeptAndSmoothOnesNeedFewCoefficients) {
  constexpr std::uint32_t kColumns = 90, kRows = 70;
  const auto mask = test::random_mask(kColumns, kRows, 5);
  const std::uint32_t levels = rectangular_levels(kColumns, kRows);
  const auto bands = wavelet_bands(kColumns, kRows, levels);
  const std::vector<std::uint8_t> support(mask.size(), 1);
  std::vector<double> samples(mask.size(), std::nan(""));
  for (std::uint32_t r = 0; r < kRows; ++r)
    for (std::uint32_t c = 0; c < kColumns; ++c)
      if (mask[r * kColumns + c]) samples[r * kColumns + c] = 3 + std::sin(0.03 * c) * std::cos(0.04 * r);
  const double step = 1e-3;
  std::vector<double> steps;
  for (const Band& band : bands) steps.push_back(step / synthesis_norm(band));
  FittedSamples whole;
  auto fitted = fit_coefficients(kColumns, kRows, levels, samples, support, bands, steps, whole);
  std::vector<double> with_zeros_outside = samples;
  for (double& sample : with_zeros_outside)
    if (std::isnan(sample)) sample = 0;
  rectangular_analysis(kColumns, kRows, levels, with_zeros_outside);
  const auto count_large = [&](const std::vector<double>& coefficients) {
    std::size_t large = 0;
    for (std::size_t b = 0; b < bands.size(); ++b)
      for (std::uint32_t r = bands[b].row; r < bands[b].row + bands[b].rows; ++r)
        for (std::uint32_t c = bands[b].column; c < bands[b].column + bands[b].columns; ++c)
          large += bands[b].kind != 0 && std::abs(coefficients[r * kColumns + c]) > steps[b];
    return large;
  };
  EXPECT_LT(count_large(fitted), count_large(with_zeros_outside) / 2);
  // Going on from there with the same steps, no more are needed.
  EXPECT_LE(count_large(fit_coefficients(kColumns, kRows, levels, samples, support, bands, steps, whole)),
            count_large(fitted));
  rectangular_synthesis(kColumns, kRows, levels, fitted);
  for (std::size_t i = 0; i < mask.size(); ++i) EXPECT_TRUE(!mask[i] || std::abs(fitted[i] - samples[i]) < 1e-9);
}

}  // namespace
}  // namespace emap
