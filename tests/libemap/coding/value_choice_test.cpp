#include "libemap/coding/value_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libemap/coding/coefficient_coding.h"
#include "libemap/coding/coefficient_support.h"
#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

constexpr double kStep = 0.01;

std::vector<double> coefficients_of(const QuantisedMap& map) {
  std::vector<double> coefficients(map.values.size());
  for (const Band& band : map.bands)
    for_band(band, map.columns, [&](std::size_t i) {
      coefficients[i] = step_of_band(band, kStep) * reconstructed(map.values[i], band.kind);
    });
  return coefficients;
}

std::vector<double> samples_of(const QuantisedMap& map) {
  std::vector<double> samples = coefficients_of(map);
  rectangular_synthesis(map.columns, map.rows, rectangular_levels(map.columns, map.rows), samples);
  return samples;
}

void sweep(const ValueChoice& choice, QuantisedMap& map, int times) {
  for (int i = 0; i < times; ++i) {
    MagnitudeCosts costs;
    costs.count(map);
    costs.finish();
    choice.sweep(costs, kStep, map);
  }
}

TEST(ValueChoice, FindsTheValuesThatMadeTheSamples) {
  constexpr std::array<std::array<std::uint32_t, 2>, 5> kSizes = {{{90, 71}, {33, 64}, {128, 5}, {1, 40}, {17, 17}}};
  for (const auto [columns, rows] : kSizes) {
    ElevationPatch patch;
    patch.columns = columns;
    patch.rows = rows;
    patch.mask.assign(std::size_t{columns} * rows, 1);
    QuantisedMap wanted = quantised_map(patch.columns, patch.rows, patch.mask);
    test::Random32 random(columns);
    for (std::size_t i = 0; i < wanted.values.size(); ++i) {
      const auto magnitude = static_cast<std::int32_t>(random() % 8 == 0 ? 20 + random() % 200 : 0);
      if (wanted.support[i]) wanted.values[i] = random() % 2 ? magnitude : -magnitude;
    }
    patch.elevation = samples_of(wanted);
    const ValueChoice choice(patch, wanted);
    QuantisedMap found = quantised_map(patch.columns, patch.rows, patch.mask);
    sweep(choice, found, 40);
    EXPECT_EQ(found.values, wanted.values) << columns << " x " << rows;
  }
}

TEST(ValueChoice, IsWorthMoreThanRounding) {
  ElevationPatch patch;
  patch.columns = 120;
  patch.rows = 100;
  patch.mask = test::random_mask(patch.columns, patch.rows, 3);
  patch.elevation.resize(patch.mask.size());
  test::Random32 random(3);
  for (std::uint32_t r = 0; r < patch.rows; ++r)
    for (std::uint32_t c = 0; c < patch.columns; ++c)
      patch.elevation[r * patch.columns + c] =
          std::sin(0.05 * c) * std::cos(0.07 * r) + 0.05 * std::sin(0.4 * c) + (random() % 1000) * 2e-5;
  QuantisedMap rounded = quantised_map(patch.columns, patch.rows, patch.mask);
  std::vector<double> wanted = patch.elevation;
  rectangular_analysis(patch.columns, patch.rows, rectangular_levels(patch.columns, patch.rows), wanted);
  for (const Band& band : rounded.bands)
    for_band(band, patch.columns, [&](std::size_t i) {
      if (rounded.support[i])
        rounded.values[i] = static_cast<std::int32_t>(std::lround(wanted[i] / step_of_band(band, kStep)));
    });
  QuantisedMap chosen = rounded;
  sweep(ValueChoice(patch, chosen), chosen, 3);

  const auto bits_and_error = [&](QuantisedMap& map) {
    BitCounter counter;
    CoefficientCoding().code(counter, map);
    const std::vector<double> samples = samples_of(map);
    double error = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (patch.mask[i]) error += std::pow((samples[i] - patch.elevation[i]) / (2 * kStep), 2);
    return std::pair(counter.bits(), error);
  };
  const auto [bits, error] = bits_and_error(chosen);
  const auto [rounded_bits, rounded_error] = bits_and_error(rounded);
  EXPECT_LT(error + 0.1 * bits, 0.9 * (rounded_error + 0.1 * rounded_bits));
  for (std::size_t i = 0; i < chosen.values.size(); ++i) EXPECT_TRUE(chosen.support[i] || chosen.values[i] == 0);
}

}  // namespace
}  // namespace emap
