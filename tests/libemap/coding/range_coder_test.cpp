#include "libemap/coding/range_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/random32.h"

namespace emap {
namespace {

struct Decision {
  bool bit;
  std::uint32_t probability_of_one;
};

std::vector<Decision> random_decisions(std::size_t count, unsigned seed) {
  test::Random32 random(seed);
  std::vector<Decision> decisions;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t kind = random() % 4;
    const std::uint32_t p = kind == 0 ? 1 : kind == 1 ? 65535 : 1 + random() % 65535;
    // Now and then the unlikely happens, so that carries run through many bytes.
    decisions.push_back({random() % 65536 < p, p});
    if (random() % 50 == 0) decisions.back().bit = !decisions.back().bit;
  }
  return decisions;
}

std::vector<std::uint8_t> written(const std::vector<Decision>& decisions) {
  RangeEncoder encoder;
  for (const Decision& decision : decisions) encoder.code(decision.bit, decision.probability_of_one);
  return encoder.finish();
}

TEST(RangeCoder, ReadsBackWhatWasWritten) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto decisions = random_decisions(seed * 7 % 900, seed);
    const auto bytes = written(decisions);
    RangeDecoder decoder(bytes);
    for (std::size_t i = 0; i < decisions.size(); ++i)
      ASSERT_EQ(decoder.code(false, decisions[i].probability_of_one), decisions[i].bit) << "seed " << seed << ", " << i;
    EXPECT_FALSE(decoder.exhausted());
  }
}

// The oracle is Shannon's: what a decision with probability p must cost is -log2 p.
TEST(RangeCoder, TakesAsManyBytesAsTheProbabilitiesSay) {
  test::Random32 random(3);
  std::vector<Decision> decisions;
  double bits = 0;
  BitCounter counter;
  for (int i = 0; i < 100000; ++i) {
    const std::uint32_t p = 200 + random() % 65000;
    decisions.push_back({random() % 65536 < p, p});
    bits -= std::log2((decisions.back().bit ? p : 65536 - p) / 65536.0);
    counter.code(decisions.back().bit, p);
  }
  EXPECT_NEAR(8.0 * static_cast<double>(written(decisions).size()), bits, 0.0002 * bits + 32);
  EXPECT_NEAR(counter.bits(), bits, 0.003 * bits);
}

TEST(RangeCoder, NothingTakesNothing) {
  EXPECT_TRUE(written({}).empty());
}

TEST(RangeCoder, AReaderOfACutStreamKnowsIt) {
  const auto decisions = random_decisions(4000, 5);
  const auto bytes = written(decisions);
  const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + bytes.size() / 2);
  RangeDecoder decoder(cut);
  for (const Decision& decision : decisions) decoder.code(false, decision.probability_of_one);
  EXPECT_TRUE(decoder.exhausted());
}

}  // namespace
}  // namespace emap
