#include "libthin/foundation/memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace thin {
namespace {

TEST(PeakMemory, SeesWhatWasTakenAndGivenBack) {
  constexpr std::uint64_t bytes = 200'000'000;
  const PeakMemory before;
  if (!before.bytes_above_start()) GTEST_SKIP() << "this kernel does not say";
  {
    const std::vector<char> block(bytes, 1);
    EXPECT_EQ(block[bytes / 2], 1);
  }
  EXPECT_GT(*before.bytes_above_start(), bytes * 9 / 10);
  EXPECT_LT(*before.bytes_above_start(), bytes * 12 / 10);
  const PeakMemory after;  // the mark begins anew
  EXPECT_LT(*after.bytes_above_start(), bytes / 10);
}

}  // namespace
}  // namespace thin
