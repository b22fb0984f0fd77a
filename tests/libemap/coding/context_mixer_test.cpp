#include "libemap/coding/context_mixer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "tests/support/random32.h"

namespace emap {
namespace {

TEST(ContextMixer, SquashIsTheLogisticFunctionAndStretchItsInverse) {
  for (std::int32_t x = -2500; x <= 2500; ++x) {
    const double exact = 65536 / (1 + std::exp(-x / 256.0));
    EXPECT_NEAR(squash(x), exact, 0.012 * std::min(exact, 65536 - exact) + 150) << x;  // a polyline of 40 pieces
    EXPECT_GE(squash(x), squash(x - 1));
  }
  for (std::uint32_t p = 1; p < 4096; ++p) EXPECT_NEAR(squash(stretch(p)), p * 16 + 8, 70) << p;
}

struct Source {
  test::Random32 random{7};
  std::uint32_t previous = 0, before = 0;
  // Depends on the last bit strongly, on the one before weakly.
  bool next() {
    const double p = previous ? (before ? 0.95 : 0.85) : 0.08;
    before = previous;
    previous = std::uniform_real_distribution<double>(0, 1)(random) < p;
    return previous != 0;
  }
};

TEST(ContextMixer, ReaderAndWriterLearnAlike) {
  const std::array<std::uint32_t, 3> counts = {2, 4, 1};
  ContextMixer writing(counts, 2), reading(counts, 2);
  RangeEncoder encoder;
  std::vector<bool> bits;
  Source source;
  std::uint32_t a = 0, b = 0;
  for (int i = 0; i < 5000; ++i) {
    const bool bit = source.next();
    writing.code(encoder, bit, std::array{a, a * 2 + b, 0U}, i % 2);
    bits.push_back(bit);
    b = a;
    a = bit;
  }
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  a = b = 0;
  for (int i = 0; i < 5000; ++i) {
    const bool bit = reading.code(decoder, false, std::array{a, a * 2 + b, 0U}, i % 2);
    ASSERT_EQ(bit, bits[i]) << i;
    b = a;
    a = bit;
  }
}

// The oracle is the source's own entropy; learning may cost a few per cent.
TEST(ContextMixer, FindsTheContextThatTells) {
  const std::array<std::uint32_t, 3> counts = {2, 4, 64};
  ContextMixer mixer(counts, 1);
  BitCounter counter;
  Source source;
  double entropy = 0;
  std::uint32_t a = 0, b = 0;
  test::Random32 noise(2);
  for (int i = 0; i < 20000; ++i) {
    const double p = a ? (b ? 0.95 : 0.85) : 0.08;
    const bool bit = source.next();
    entropy -= std::log2(bit ? p : 1 - p);
    mixer.code(counter, bit, std::array<std::uint32_t, 3>{a, a * 2 + b, noise() % 64}, 0);
    b = a;
    a = bit;
  }
  EXPECT_LT(counter.bits(), 1.04 * entropy);
}

}  // namespace
}  // namespace emap
