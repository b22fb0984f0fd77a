#include "daemon/completeness.h"

#include <gtest/gtest.h>

namespace thind {
namespace {

using std::chrono::milliseconds;

class CompletenessTest : public testing::Test {
 protected:
  Completeness::Time at(int time_ms) const { return start_ + milliseconds(time_ms); }
  FileStamp stamp(std::int64_t size_bytes) const { return {1, 2, size_bytes, 3, 4}; }
  std::vector<std::string> due(int time_ms) const { return completeness_.due(at(time_ms)); }

  Completeness::Time start_ = std::chrono::steady_clock::now();
  Completeness completeness_{milliseconds(100)};
};

TEST_F(CompletenessTest, RestsAfterTheSettlingTime) {
  completeness_.observe("a", stamp(1), at(0), 0);
  EXPECT_TRUE(due(99).empty());
  EXPECT_EQ(due(100), std::vector<std::string>{"a"});
  EXPECT_EQ(completeness_.next_due(), at(100));
}

TEST_F(CompletenessTest, AnyChangeStartsTheTimeAnew) {
  completeness_.observe("a", stamp(1), at(0), 7);
  completeness_.observe("a", stamp(2), at(90), 8);
  EXPECT_TRUE(due(189).empty());
  EXPECT_EQ(due(190).size(), 1U);
  EXPECT_EQ(completeness_.noticed_ms("a"), 7) << "it was noticed when it first appeared";
  FileStamp replaced = stamp(2);
  replaced.inode = 99;
  completeness_.observe("a", replaced, at(200), 9);
  EXPECT_TRUE(due(299).empty()) << "another file of the same name, size and time";
}

TEST_F(CompletenessTest, LookingWithoutChangeDoesNotDelay) {
  for (int time_ms = 0; time_ms < 100; time_ms += 10) completeness_.observe("a", stamp(1), at(time_ms), 0);
  EXPECT_EQ(due(100).size(), 1U);
}

TEST_F(CompletenessTest, WaitingFilesAreNotDueUntilTheyChange) {
  completeness_.observe("a", stamp(1), at(0), 0);
  completeness_.set_waiting("a", false);
  EXPECT_TRUE(due(1000).empty());
  EXPECT_FALSE(completeness_.next_due());
  EXPECT_TRUE(completeness_.all_waiting());
  EXPECT_EQ(completeness_.oldest_undecided_ms(), 0);
  completeness_.set_waiting("a", true);
  EXPECT_FALSE(completeness_.oldest_undecided_ms());
  completeness_.observe("a", stamp(2), at(1000), 5);
  EXPECT_FALSE(completeness_.all_waiting());
  EXPECT_EQ(due(1100).size(), 1U);
  EXPECT_EQ(completeness_.oldest_undecided_ms(), 0);
}

TEST_F(CompletenessTest, OldestIsTheFirstNoticed) {
  completeness_.observe("late", stamp(1), at(0), 50);
  completeness_.observe("early", stamp(1), at(0), 20);
  EXPECT_EQ(completeness_.oldest_undecided_ms(), 20);
  completeness_.forget("early");
  EXPECT_EQ(completeness_.oldest_undecided_ms(), 50);
}

}  // namespace
}  // namespace thind
