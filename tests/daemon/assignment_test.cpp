#include "daemon/assignment.h"

#include <gtest/gtest.h>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

class AssignmentTest : public testing::Test {
 protected:
  AssignmentTest() : journal_((folder_.path() / "journal.sqlite").string(), Database::Access::read_write) {
    settings_.daemon.inbox = settings_.daemon.outbox = settings_.daemon.archive = folder_.path().string();
    settings_.daemon.quarantine = settings_.daemon.late = settings_.daemon.state = folder_.path().string();
    settings_.window.length_minutes = 1;
    std::filesystem::create_directory(folder_.path() / "spool");
  }
  // A staged file with observations in the minutes first..last.
  void arrive(const std::string& hash, std::int64_t first, std::int64_t last) {
    thin::test::write_content(folder_.path() / "spool" / hash, "content");
    journal_.record_seen(hash, hash, 1, 0);
    journal_.record_staged(hash, {first * 60'000, last * 60'000, 1, {}});
    assign_to_windows(journal_, settings_, Folders(settings_.daemon), *journal_.file(hash), 0);
  }
  void close(std::int64_t window) { journal_.record_outcome(window, {.output = "output"}, 0); }
  std::vector<std::string> members(std::int64_t window) {
    std::vector<std::string> hashes;
    for (const Member& member : journal_.members(window)) hashes.push_back(member.file.hash);
    return hashes;
  }
  using Names = std::vector<std::string>;

  thin::test::TemporaryFolder folder_;
  Journal journal_;
  Settings settings_;
};

TEST_F(AssignmentTest, JoinsTheOpenWindows) {
  arrive("a", 0, 1);
  arrive("b", 1, 1);
  const auto windows = journal_.windows();
  ASSERT_EQ(windows.size(), 2U);
  EXPECT_EQ(members(windows[0].id), Names{"a"});
  EXPECT_EQ(members(windows[1].id), (Names{"a", "b"}));
}

TEST_F(AssignmentTest, LateDataMakesALaterVersionWithEverything) {
  arrive("a", 0, 0);
  close(1);
  arrive("b", 0, 0);
  const WindowRecord latest = *journal_.latest_window(WindowKind::window, {0, 60'000});
  EXPECT_EQ(latest.version, 2);
  EXPECT_EQ(latest.state, WindowState::open);
  EXPECT_EQ(members(latest.id), (Names{"a", "b"}));
  EXPECT_EQ(journal_.file("a")->state, FileState::published) << "it was published and stays so";
}

TEST_F(AssignmentTest, AWindowAtWorkIsClosed) {
  arrive("a", 0, 0);
  journal_.begin_window_attempt(1);
  arrive("b", 0, 0);
  EXPECT_EQ(members(1), Names{"a"});
  EXPECT_EQ(members(2), (Names{"a", "b"}));
  EXPECT_TRUE(journal_.has_unfinished_before(*journal_.window(2))) << "the versions keep their order";
}

TEST_F(AssignmentTest, RethinNeedsTheOriginals) {
  arrive("a", 0, 0);
  close(1);
  std::filesystem::remove(folder_.path() / "spool" / "a");
  arrive("b", 0, 0);
  EXPECT_EQ(journal_.window(2)->kind, WindowKind::late);
  EXPECT_EQ(members(2), Names{"b"});
}

TEST_F(AssignmentTest, LateDataIsThinnedSeparately) {
  settings_.window.late = WindowSettings::Late::separate;
  arrive("a", 0, 0);
  close(1);
  arrive("b", 0, 0);
  arrive("c", 0, 0);
  EXPECT_EQ(journal_.window(2)->kind, WindowKind::late);
  EXPECT_EQ(members(2), (Names{"b", "c"}));
  close(2);
  arrive("d", 0, 0);
  EXPECT_EQ(journal_.window(3)->version, 2);
  EXPECT_EQ(members(3), Names{"d"});
}

TEST_F(AssignmentTest, LateDataIsDroppedAndCounted) {
  settings_.window.late = WindowSettings::Late::drop;
  arrive("a", 0, 0);
  close(1);
  arrive("b", 0, 0);
  EXPECT_EQ(journal_.window(1)->dropped, 1);
  EXPECT_EQ(journal_.file("b")->state, FileState::published);
  EXPECT_EQ(journal_.file("b")->outcome, kLateOutcome);
  arrive("c", 0, 1);
  EXPECT_EQ(journal_.file("c")->state, FileState::staged) << "its other window is still to come";
}

TEST_F(AssignmentTest, InPerFileModeEachHasItsOwn) {
  settings_.window.mode = WindowSettings::Mode::per_file;
  arrive("a", 0, 99);
  arrive("b", 0, 0);
  EXPECT_EQ(members(1), Names{"a"});
  EXPECT_EQ(members(2), Names{"b"});
  EXPECT_EQ(journal_.window(1)->kind, WindowKind::file);
}

}  // namespace
}  // namespace thind
