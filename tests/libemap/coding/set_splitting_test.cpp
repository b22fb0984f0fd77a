#include "libemap/coding/set_splitting.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

CoefficientPlanes empty_planes(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  const std::uint32_t levels = wavelet_levels(columns, rows);
  return {columns, rows, wavelet_bands(columns, rows, levels),
          shape_adaptive_support(columns, rows, levels, test::random_mask(columns, rows, seed))};
}

struct Filled {
  CoefficientPlanes planes;
  std::uint32_t top_plane;
};

Filled random_planes(std::uint32_t columns, std::uint32_t rows, unsigned seed) {
  CoefficientPlanes planes = empty_planes(columns, rows, seed);
  test::Random32 random(seed);
  planes.magnitudes.resize(planes.support.size());
  planes.negative.resize(planes.support.size());
  std::uint32_t all = 1;
  for (std::size_t i = 0; i < planes.support.size(); ++i) {
    if (!planes.support[i]) continue;
    planes.magnitudes[i] = (random() % 100000) >> (random() % 17);
    planes.negative[i] = random() % 2;
    all |= planes.magnitudes[i];
  }
  return {std::move(planes), static_cast<std::uint32_t>(std::bit_width(all)) - 1};
}

// The oracle: what is known of a magnitude after the last pass over it, without any sets. The plane of the last
// refinement counts for coefficients found before it, the plane of the last significance pass for finding.
std::int32_t expected_halves(std::uint32_t magnitude, bool negative, std::uint32_t top_plane, std::uint32_t passes) {
  if (passes == 0) return 0;
  const std::uint32_t last = top_plane - (passes - 1) / 2;
  const bool refined = passes % 2 == 0;
  if (magnitude >> last == 0) return 0;
  const bool just_found = magnitude >> last == 1;
  const std::uint32_t known = refined || just_found ? last : last + 1;
  const auto halves = static_cast<std::int32_t>(((magnitude >> known) * 2 + 1) << known);
  return negative ? -halves : halves;
}

TEST(SetSplitting, AReaderKnowsAfterAnyPassWhatTheBitsSay) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    auto [planes, top_plane] = random_planes(5 + seed * 11 % 60, 3 + seed * 17 % 50, seed);
    for (std::uint32_t passes = 0; passes <= 2 * (top_plane + 1); passes += 1 + seed % 3) {
      std::fill(planes.halves.begin(), planes.halves.end(), 0);
      SetSplittingCoding writing, reading;
      RangeEncoder encoder;
      writing.code(encoder, planes, top_plane, passes);
      const auto bytes = encoder.finish();

      CoefficientPlanes read(planes.columns, planes.rows, planes.bands, planes.support);
      RangeDecoder decoder(bytes);
      reading.code(decoder, read, top_plane, passes);
      EXPECT_FALSE(decoder.exhausted());
      for (std::size_t i = 0; i < read.halves.size(); ++i)
        ASSERT_EQ(read.halves[i], expected_halves(planes.magnitudes[i], planes.negative[i], top_plane, passes))
            << "seed " << seed << ", " << passes << " passes, coefficient " << i;
    }
  }
}

TEST(SetSplitting, TheObserverSeesEveryChange) {
  auto [planes, top_plane] = random_planes(40, 30, 3);
  std::vector<std::int32_t> followed(planes.halves.size());
  int passes_seen = 0;
  const SetSplittingCoding::Observer observer{[&](std::uint32_t index, std::int32_t before, std::int32_t after) {
                                                EXPECT_EQ(followed[index], before);
                                                followed[index] = after;
                                              },
                                              [&] { ++passes_seen; }};
  SetSplittingCoding coding;
  BitCounter counter;
  coding.code(counter, planes, top_plane, 10, &observer);
  EXPECT_EQ(followed, planes.halves);
  EXPECT_EQ(passes_seen, 10);
}

}  // namespace
}  // namespace emap
