#pragma once

// Real observations and models that are not part of this project: read in place where they are, never copied.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace thin::test {

// $THIN_SHARED_DATA, or ../shared/data beside the source tree.
inline std::filesystem::path shared_data() {
  if (const char* path = std::getenv("THIN_SHARED_DATA")) return path;
  return std::filesystem::path(__FILE__).parent_path() / "../../../shared/data";
}

}  // namespace thin::test

#define THIN_REQUIRE_SHARED_DATA()                         \
  if (!std::filesystem::exists(thin::test::shared_data())) \
  GTEST_SKIP() << "no shared data at " << thin::test::shared_data() << "; set THIN_SHARED_DATA to its path"
