#include "libthin/foundation/result.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <memory>

namespace thin {
namespace {

TEST(Result, HoldsAValueOrAnError) {
  const Result<int> good = 7;
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 7);
  const Result<int> bad = Error{ErrorKind::input, "no"};
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "no");
  EXPECT_TRUE(Result<void>());
  EXPECT_FALSE(Result<void>(Error{ErrorKind::internal, "no"}));
}

TEST(Result, PassesOnWhatCanOnlyBeMoved) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> taken = std::move(*result);
  EXPECT_EQ(*taken, 3);
}

TEST(Result, AFullDiskIsTheMachinesMaking) {
  EXPECT_EQ(kind_of_errno(ENOSPC), ErrorKind::temporary);
  EXPECT_EQ(kind_of_errno(EIO), ErrorKind::temporary);
  EXPECT_EQ(kind_of_errno(ENOENT), ErrorKind::internal);
  EXPECT_EQ(exit_code(kind_of_errno(ENOSPC)), 75);
  EXPECT_EQ(system_error("write", "/a/b", ENOSPC).message, "cannot write /a/b: No space left on device");
}

}  // namespace
}  // namespace thin
