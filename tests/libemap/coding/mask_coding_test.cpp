#include "libemap/coding/mask_coding.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/random32.h"
#include "tests/support/synthetic_maps.h"

namespace emap {
namespace {

struct Sized {
  std::uint32_t columns, rows;
  std::vector<std::uint8_t> mask;
};

std::vector<Sized> awkward_masks() {
  std::vector<Sized> masks;
  for (const auto& [columns, rows] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {0, 0}, {1, 1}, {8, 8}, {9, 7}, {1, 40}, {40, 1}, {63, 65}, {128, 100}}) {
    const std::size_t count = std::size_t{columns} * rows;
    masks.push_back({columns, rows, std::vector<std::uint8_t>(count, 0)});
    masks.push_back({columns, rows, std::vector<std::uint8_t>(count, 1)});
    masks.push_back({columns, rows, test::random_mask(columns, rows, 4)});
    test::Random32 random(columns);
    std::vector<std::uint8_t> noise(count);
    for (auto& sample : noise) sample = random() % 2;
    masks.push_back({columns, rows, noise});
  }
  return masks;
}

TEST(MaskCoding, ReadsBackWhatWasWritten) {
  MaskCoding writing, reading;
  RangeEncoder encoder;
  for (Sized sized : awkward_masks()) writing.code(encoder, sized.columns, sized.rows, sized.mask);
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (const Sized& sized : awkward_masks()) {
    std::vector<std::uint8_t> read(sized.mask.size());
    reading.code(decoder, sized.columns, sized.rows, read);
    EXPECT_EQ(read, sized.mask) << sized.columns << " x " << sized.rows;
  }
  EXPECT_FALSE(decoder.exhausted());
}

TEST(MaskCoding, ADiscCostsThreeBitsForEachRowAndSideAtMost) {
  std::vector<std::uint8_t> disc(200 * 200);
  for (int r = 0; r < 200; ++r)
    for (int c = 0; c < 200; ++c) disc[r * 200 + c] = std::hypot(r - 99.3, c - 100.2) < 90.4;
  MaskCoding coding;
  BitCounter counter;
  coding.code(counter, 200, 200, disc);
  EXPECT_LT(counter.bits(), 3.0 * 2 * 181);
}

}  // namespace
}  // namespace emap
