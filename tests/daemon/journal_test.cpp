#include "daemon/journal.h"

#include <gtest/gtest.h>

#include <memory>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

class JournalTest : public testing::Test {
 protected:
  JournalTest() { reopen(); }
  // As after a crash: nothing but the file is left.
  void reopen() {
    journal_.reset();
    journal_ = std::make_unique<Journal>((folder_.path() / "journal.sqlite").string(), Database::Access::read_write);
  }
  void see(const std::string& hash) { journal_->record_seen(hash, hash + ".bufr", 10, 1000); }
  void stage(const std::string& hash) {
    see(hash);
    journal_->record_staged(hash, {.first_ms = 0, .last_ms = 9, .observations = 5, .platforms = {3, 223}});
  }
  std::int64_t window_with(const std::vector<std::string>& hashes) {
    const std::int64_t window = journal_->create_window(WindowKind::window, {0, 10}, 1, 1000);
    for (const std::string& hash : hashes) journal_->add_member(window, hash, 1000);
    return window;
  }
  FileState state(const std::string& hash) { return journal_->file(hash)->state; }
  void expect_counts(std::int64_t published, std::int64_t quarantined, std::int64_t pending) {
    const FileCounts counts = journal_->counts();
    EXPECT_EQ(counts.published, published);
    EXPECT_EQ(counts.quarantined, quarantined);
    EXPECT_EQ(counts.pending, pending);
    EXPECT_TRUE(counts.balanced());
  }

  thin::test::TemporaryFolder folder_;
  std::unique_ptr<Journal> journal_;
};

TEST_F(JournalTest, KeepsWhatItWasTold) {
  stage("a");
  reopen();
  const FileRecord file = *journal_->file("a");
  EXPECT_EQ(file.name, "a.bufr");
  EXPECT_EQ(file.size_bytes, 10);
  EXPECT_EQ(file.state, FileState::staged);
  EXPECT_EQ(file.first_ms, 0);
  EXPECT_EQ(file.last_ms, 9);
  EXPECT_EQ(file.platforms, (std::vector<int>{3, 223}));
  EXPECT_TRUE(file.staged);
  EXPECT_FALSE(journal_->file("b"));
}

TEST_F(JournalTest, EachContentIsInOneState) {
  see("a");
  expect_counts(0, 0, 1);
  stage("b");
  stage("c");
  journal_->record_quarantined("c", "why", "{}", 2000);
  expect_counts(0, 1, 2);
  const std::int64_t window = window_with({"b"});
  journal_->record_outcome(window, {.output = "out"}, 3000);
  expect_counts(1, 1, 1);
  journal_->record_incomplete("a", "no end");
  expect_counts(1, 1, 1);
  journal_->record_withdrawal("a");
  expect_counts(1, 1, 0);
  EXPECT_EQ(journal_->counts().withdrawn, 1);
}

TEST_F(JournalTest, RefusesTransitionsThatTheDrawingDoesNotHave) {
  stage("a");
  EXPECT_THROW(see("a"), JournalError);
  EXPECT_THROW(journal_->record_incomplete("a", ""), JournalError);
  EXPECT_THROW(journal_->record_growth("a", "b", 1), JournalError);
  EXPECT_THROW(journal_->record_withdrawal("a"), JournalError);
  EXPECT_THROW(journal_->record_retry("a", "x"), JournalError);
  EXPECT_THROW(journal_->record_staged("unknown", {}), JournalError);
  journal_->record_outcome(window_with({"a"}), {}, 1);
  EXPECT_THROW(journal_->record_quarantined("a", "", "", 1), JournalError) << "published";
  expect_counts(1, 0, 0);
}

TEST_F(JournalTest, AFileInTwoWindowsIsPublishedWithTheLast) {
  stage("a");
  const std::int64_t first = window_with({"a"}), second = window_with({"a"});
  journal_->record_outcome(first, {.output = "one"}, 1);
  EXPECT_EQ(state("a"), FileState::staged);
  EXPECT_TRUE(journal_->unsettled().empty());
  journal_->record_outcome(second, {.output = "two"}, 2);
  EXPECT_EQ(state("a"), FileState::published);
  EXPECT_EQ(journal_->file("a")->outcome, "in one, two");
  EXPECT_EQ(journal_->unsettled().size(), 1U);
}

TEST_F(JournalTest, QuarantineLeavesTheWindowsThatAreToCome) {
  stage("a");
  stage("b");
  const std::int64_t window = window_with({"a", "b"});
  journal_->record_quarantined("a", "why", "{}", 1);
  ASSERT_EQ(journal_->members(window).size(), 1U);
  EXPECT_EQ(journal_->members(window)[0].file.hash, "b");
}

TEST_F(JournalTest, AnEmptyWindowSaysWhy) {
  stage("a");
  journal_->record_outcome(window_with({"a"}), {.state = WindowState::empty, .reason = "all screened out"}, 1);
  EXPECT_EQ(state("a"), FileState::published);
  EXPECT_EQ(journal_->file("a")->outcome, "nothing retained: all screened out");
}

TEST_F(JournalTest, AttemptsAreOnDiskBeforeTheWork) {
  see("a");
  journal_->begin_file_attempt("a");
  reopen();
  EXPECT_EQ(journal_->file("a")->attempts, 1);
  journal_->count_interruptions();
  EXPECT_EQ(journal_->file("a")->attempts, 0) << "the daemon died, not the worker";
  EXPECT_EQ(journal_->file("a")->interruptions, 1);
  journal_->count_interruptions();
  EXPECT_EQ(journal_->file("a")->interruptions, 1) << "nothing was running";
}

TEST_F(JournalTest, FailuresCountAndExcusesDoNot) {
  see("a");
  journal_->begin_file_attempt("a");
  journal_->end_file_attempt("a", 5);
  journal_->begin_file_attempt("a");
  journal_->excuse_file_attempt("a", 77);
  const FileRecord file = *journal_->file("a");
  EXPECT_EQ(file.attempts, 1);
  EXPECT_EQ(file.deferrals, 1);
  EXPECT_EQ(file.not_before_ms, 77);
}

TEST_F(JournalTest, HandsOutWhatIsDueAndNotAtWork) {
  for (const char* hash : {"a", "b", "c"}) see(hash);
  EXPECT_EQ(journal_->to_ingest(0, 2).size(), 2U);
  journal_->begin_file_attempt("a");
  journal_->begin_file_attempt("b");
  journal_->excuse_file_attempt("b", 77);
  ASSERT_EQ(journal_->to_ingest(76, 9).size(), 1U);
  EXPECT_EQ(journal_->to_ingest(76, 9)[0].hash, "c");
  EXPECT_EQ(journal_->to_ingest(77, 9).size(), 2U);
  EXPECT_EQ(journal_->next_ingest_ms(), 0);
  EXPECT_EQ(journal_->ingest_counts(1).waiting, 3);
  EXPECT_EQ(journal_->ingest_counts(1).hopeful, 2);
}

TEST_F(JournalTest, GrowthIsTheSameDelivery) {
  see("short");
  journal_->record_incomplete("short", "no end");
  journal_->record_growth("short", "long", 20);
  EXPECT_FALSE(journal_->file("short"));
  EXPECT_EQ(journal_->file("long")->size_bytes, 20);
  EXPECT_EQ(state("long"), FileState::seen);
  expect_counts(0, 0, 1);
}

TEST_F(JournalTest, StagedAgainWhenALaterVersionNeedsIt) {
  stage("a");
  journal_->record_outcome(window_with({"a"}), {.output = "one"}, 1);
  journal_->record_unstaged("a");
  EXPECT_TRUE(journal_->to_ingest(0, 9).empty());
  window_with({"a"});
  ASSERT_EQ(journal_->to_ingest(0, 9).size(), 1U);
  journal_->record_staged("a", {});
  EXPECT_TRUE(journal_->to_ingest(0, 9).empty());
  EXPECT_EQ(state("a"), FileState::published);
}

TEST_F(JournalTest, ATransactionIsAllOrNothing) {
  EXPECT_THROW(journal_->atomically([&] {
    see("a");
    journal_->atomically([&] { see("b"); });
    throw JournalError("in the middle");
  }),
               JournalError);
  EXPECT_FALSE(journal_->file("a"));
  EXPECT_FALSE(journal_->file("b"));
  expect_counts(0, 0, 0);
  see("a");
  expect_counts(0, 0, 1);
}

TEST_F(JournalTest, IsReadWhileItIsWritten) {
  see("a");
  Journal reader((folder_.path() / "journal.sqlite").string(), Database::Access::read_only);
  reader.atomically_reading([&] {
    EXPECT_EQ(reader.counts().pending, 1);
    see("b");
    EXPECT_EQ(reader.counts().pending, 1) << "of one moment";
  });
  EXPECT_EQ(reader.counts().pending, 2);
  EXPECT_THROW(reader.record_duplicate(), JournalError);
}

TEST_F(JournalTest, RefusesAJournalOfAnotherLayout) {
  {
    Database database((folder_.path() / "other.sqlite").string(), Database::Access::read_write);
    database.execute("PRAGMA user_version = 99");
  }
  EXPECT_THROW(Journal((folder_.path() / "other.sqlite").string(), Database::Access::read_write), JournalError);
}

}  // namespace
}  // namespace thind
