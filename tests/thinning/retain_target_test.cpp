#include "libthin/thinning/retain_target.h"

#include <gtest/gtest.h>

namespace thin {
namespace {

TEST(RetainTarget, CountsOutOfN) {
  RetainTarget count, fraction;
  count.retain_count = 10;
  EXPECT_EQ(count.count_of(7), 7U);
  EXPECT_EQ(count.count_of(100), 10U);
  fraction.retain_fraction = 0.1;
  EXPECT_EQ(fraction.count_of(0), 0U);
  EXPECT_EQ(fraction.count_of(1), 1U);
  EXPECT_EQ(fraction.count_of(26), 3U);
  fraction.retain_fraction = 1;
  EXPECT_EQ(fraction.count_of(1234567), 1234567U);
  fraction.retain_fraction = 0;
  EXPECT_EQ(fraction.count_of(5), 0U);
}

TEST(RetainTarget, WantsExactlyOneOfTheTwo) {
  RetainTarget target;
  EXPECT_TRUE(target.conflict());
  target.retain_count = 5;
  EXPECT_FALSE(target.conflict());
  target.retain_fraction = 0.5;
  EXPECT_TRUE(target.conflict());
}

}  // namespace
}  // namespace thin
