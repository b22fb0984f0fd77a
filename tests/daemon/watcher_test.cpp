#include "daemon/watcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

using thin::test::wait_until;
using thin::test::write_content;

class WatcherTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  bool reports(Watcher& watcher, const std::string& name) {
    return wait_until([&] {
      const auto names = watcher.take().names;
      return std::find(names.begin(), names.end(), name) != names.end();
    });
  }
  thin::test::TemporaryFolder folder_;
};

TEST_F(WatcherTest, ReportsWhatWasClosedAfterWriting) {
  Watcher watcher(folder_.path().string(), false);
  ASSERT_EQ(watcher.problem(), "");
  write_content(path("a"), "text");
  EXPECT_TRUE(reports(watcher, "a"));
}

TEST_F(WatcherTest, ReportsWhatWasMovedIn) {
  write_content(path(".a"), "text");
  Watcher watcher(folder_.path().string(), false);
  std::filesystem::rename(path(".a"), path("a"));
  EXPECT_TRUE(reports(watcher, "a"));
}

TEST_F(WatcherTest, IsSilentWhileAFileIsStillWritten) {
  Watcher watcher(folder_.path().string(), false);
  std::ofstream writing(path("a"));
  writing << "half" << std::flush;
  write_content(path("b"), "whole");
  const auto names = watcher.take().names;  // inotify keeps the order: a would come before b
  EXPECT_EQ(names, std::vector<std::string>{"b"});
}

TEST_F(WatcherTest, AsksForARescanWhenTheFolderIsReplaced) {
  std::filesystem::create_directory(path("inbox"));
  Watcher watcher(path("inbox").string(), false);
  std::filesystem::rename(path("inbox"), path("old"));
  std::filesystem::create_directory(path("inbox"));
  EXPECT_TRUE(wait_until([&] { return watcher.take().rescan; }));
  write_content(path("inbox") / "a", "text");
  EXPECT_TRUE(reports(watcher, "a")) << "the new folder is watched";
}

TEST_F(WatcherTest, TriesAgainWhereTheFolderWasGone) {
  Watcher watcher(path("inbox").string(), false);
  EXPECT_NE(watcher.problem(), "");
  EXPECT_EQ(watcher.descriptor(), -1);
  std::filesystem::create_directory(path("inbox"));
  watcher.renew();
  EXPECT_EQ(watcher.problem(), "");
  write_content(path("inbox") / "a", "text");
  EXPECT_TRUE(reports(watcher, "a"));
}

TEST_F(WatcherTest, PollingMeansNoEvents) {
  Watcher watcher(folder_.path().string(), true);
  EXPECT_EQ(watcher.descriptor(), -1);
  EXPECT_EQ(watcher.problem(), "");
  write_content(path("a"), "text");
  EXPECT_TRUE(watcher.take().names.empty());
}

}  // namespace
}  // namespace thind
