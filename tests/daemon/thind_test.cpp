// thind as a process, with a worker that does what its inputs ask for: the promises of docs/operations.md one by one.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <fstream>
#include <random>
#include <sstream>

#include "tests/support/thind_site.h"

namespace thin::test {
namespace {

constexpr std::int64_t kMinuteMs = 60'000;
constexpr std::int64_t kBeginMs = 1'767'225'600'000;  // 2026-01-01T00:00:00Z
const std::string kWindow = "20260101T000000Z-20260101T030000Z";

// Nine observations from the given minute of 2026 on, one per second.
std::string soundings(int minute, int platform = 3, const std::string& extra = "") {
  std::string text = "SOUNDINGS\n";
  for (int i = 0; i < 9; ++i)
    text += "obs " + std::to_string(kBeginMs + minute * kMinuteMs + i * 1000) + " " + std::to_string(platform) + "\n";
  return text + extra + "END\n";
}

class ThindTest : public testing::Test {
 protected:
  bool there(const std::string& path) const { return std::filesystem::exists(site_.path(path)); }
  nlohmann::json reason(const std::string& file) const {
    return nlohmann::json::parse(content_of(site_.path("quarantine/" + file + ".reason.json")), nullptr, false);
  }
  // A daemon that has taken up its work.
  Process start_and_see() {
    Process daemon = site_.start();
    EXPECT_TRUE(wait_until([&] { return site_.log_says("watches"); })) << site_.log();
    return daemon;
  }
  void TearDown() override {
    if (HasFailure()) std::printf("%s\n", site_.log().c_str());
  }

  Site site_{FAKE_WORKER};
};

TEST_F(ThindTest, OnceDrainsTheInboxAndEnds) {
  site_.deliver("a.txt", soundings(0));
  site_.deliver("b.txt", soundings(30));
  site_.deliver("c.txt", soundings(200));
  EXPECT_EQ(site_.run_once(), 0);
  const auto outbox = site_.outbox();
  EXPECT_EQ(outbox.size(), 5U);
  EXPECT_EQ(outbox.count(kWindow + "/a.txt"), 1U);
  EXPECT_EQ(outbox.count(kWindow + "/b.txt"), 1U);
  EXPECT_EQ(outbox.count(kWindow + "/report.json"), 1U);
  EXPECT_EQ(outbox.count("20260101T030000Z-20260101T060000Z/c.txt"), 1U);
  EXPECT_EQ(files_below(site_.path("archive")).size(), 3U);
  EXPECT_EQ(content_of(site_.path("archive/a.txt")), soundings(0)) << "the original as it came";
  EXPECT_TRUE(files_below(site_.path("state/spool")).empty());
  EXPECT_TRUE(files_below(site_.path("state/staged")).empty());
  EXPECT_TRUE(files_below(site_.path("state/work")).empty());
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, OnceWithNothingToDoIsDone) {
  EXPECT_EQ(site_.run_once(), 0);
}

TEST_F(ThindTest, TheResultDoesNotDependOnTheParallelism) {
  Site other(FAKE_WORKER);
  site_.daemon["parallel_workers"] = "1";
  other.daemon["parallel_workers"] = "8";
  for (Site* site : {&site_, &other}) {
    for (int i = 0; i < 12; ++i) site->deliver("f" + std::to_string(i), soundings(i * 40, i));
    EXPECT_EQ(site->run_once(), 0);
  }
  EXPECT_EQ(site_.outbox(), other.outbox());
}

TEST_F(ThindTest, AFileThatSpansWindowsIsInEach) {
  site_.deliver("a.txt", "SOUNDINGS\nobs " + std::to_string(kBeginMs + 1) + " 3\nobs " +
                             std::to_string(kBeginMs + 200 * kMinuteMs) + " 3\nEND\n");
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.outbox().count(kWindow + "/a.txt"), 1U);
  EXPECT_EQ(site_.outbox().count("20260101T030000Z-20260101T060000Z/a.txt"), 1U);
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, WrongTimesAreQuarantined) {
  site_.deliver("a.txt", "SOUNDINGS\nobs 0 3\nobs " + std::to_string(kBeginMs) + " 3\nEND\n");
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_NE(reason("a.txt")["reason"].get<std::string>().find("max_windows_per_file"), std::string::npos);
}

TEST_F(ThindTest, UnusableFilesAreQuarantinedAtOnceWithTheReason) {
  site_.deliver("bad.txt", "no soundings");
  site_.deliver("good.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_EQ(content_of(site_.path("quarantine/bad.txt")), "no soundings");
  const nlohmann::json evidence = reason("bad.txt");
  EXPECT_EQ(evidence["reason"], "bad.txt can't be used: no soundings in it");
  EXPECT_EQ(evidence["exit_code"], 3);
  EXPECT_EQ(evidence["attempts"], 1);
  EXPECT_EQ(evidence["bytes"], 12);
  EXPECT_EQ(evidence["sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(site_.outbox().count(kWindow + "/good.txt"), 1U) << "a bad file is never a neighbour's concern";
  EXPECT_TRUE(site_.consistent());
  EXPECT_EQ(site_.run_once(), 0) << "nothing was quarantined in this call";
}

struct Fault {
  const char* name;
  const char* line;
  const char* key;
  nlohmann::json value;
};

class FaultTest : public ThindTest, public testing::WithParamInterface<Fault> {};

TEST_P(FaultTest, IsQuarantinedAfterThreeAttempts) {
  site_.daemon["worker_timeout_seconds"] = "1";
  site_.deliver("bad.txt", soundings(0, 3, std::string("do ingest ") + GetParam().line + "\n"));
  site_.deliver("good.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_EQ(reason("bad.txt")["attempts"], 3);
  EXPECT_EQ(reason("bad.txt")[GetParam().key], GetParam().value) << reason("bad.txt");
  EXPECT_NE(reason("bad.txt")["last_errors"].get<std::string>().find("about to"), std::string::npos);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_TRUE(site_.consistent());
}

// The window step has the same faults; the file is found to be the culprit among its neighbours.
TEST_P(FaultTest, OfAWindowIsFoundAndQuarantined) {
  site_.daemon["worker_timeout_seconds"] = "1";
  site_.deliver("a.txt", soundings(0));
  site_.deliver("bad.txt", soundings(1, 3, std::string("do window ") + GetParam().line + "\n"));
  site_.deliver("c.txt", soundings(2));
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_EQ(reason("bad.txt")[GetParam().key], GetParam().value) << reason("bad.txt");
  const auto outbox = site_.outbox();
  EXPECT_EQ(outbox.count(kWindow + "/a.txt"), 1U);
  EXPECT_EQ(outbox.count(kWindow + "/c.txt"), 1U);
  EXPECT_EQ(outbox.count(kWindow + "/bad.txt"), 0U);
  EXPECT_EQ(site_.published(), 2);
  EXPECT_EQ(site_.quarantined(), 1);
  EXPECT_TRUE(site_.consistent());
}

INSTANTIATE_TEST_SUITE_P(
    Worker, FaultTest,
    testing::Values(Fault{"crash", "crash", "signal", SIGSEGV}, Fault{"exit1", "exit 1", "exit_code", 1},
                    Fault{"exit99", "exit 99", "exit_code", 99}, Fault{"hang", "hang", "timed_out", true},
                    Fault{"garbage", "garbage", "exit_code", 0}, Fault{"lie", "lie", "exit_code", 0},
                    Fault{"chatter", "chatter", "timed_out", true}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(ThindTest, AFailureThatPassesIsForgotten) {
  const std::string flag = site_.path("flag").string();
  site_.deliver("a.txt", soundings(0, 3, "do ingest once " + flag + "\ndo window once " + flag + "2\n"));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_TRUE(site_.log_says("attempt 1"));
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, AWindowThatFailsOnlyAsAWholeIsQuarantinedAsAWhole) {
  site_.deliver("a.txt", soundings(0, 3, "do together crash\n"));
  site_.deliver("b.txt", soundings(1));
  site_.deliver("c.txt", soundings(200));
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_NE(reason("b.txt")["reason"].get<std::string>().find("none of its files does alone"), std::string::npos);
  EXPECT_EQ(site_.quarantined(), 2);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_EQ(site_.status()["windows"][0]["state"], "failed");
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, AFileThatKillsTheDaemonItselfIsQuarantined) {
  site_.daemon["max_interruptions"] = "3";
  site_.deliver("a.txt", soundings(0, 3, "do ingest kill-daemon\n"));
  for (int death = 0; death < 3; ++death) EXPECT_EQ(site_.run_once(), 1000 + SIGKILL);
  EXPECT_EQ(site_.run_once(), 3);
  EXPECT_EQ(reason("a.txt")["interruptions"], 3);
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, AFileThatKillsTheDaemonInItsWindowIsFound) {
  site_.daemon["max_interruptions"] = "2";
  site_.daemon["parallel_workers"] = "1";
  site_.deliver("a.txt", soundings(0));
  site_.deliver("bad.txt", soundings(1, 3, "do window kill-daemon\n"));
  int exit_code = 0;
  for (int run = 0; run < 6 && exit_code != 3; ++run) exit_code = site_.run_once();
  EXPECT_EQ(exit_code, 3);
  EXPECT_TRUE(there("quarantine/bad.txt"));
  EXPECT_EQ(site_.outbox().count(kWindow + "/a.txt"), 1U);
  EXPECT_TRUE(site_.consistent());
}

// Deaths from outside, however many, are nobody's fault: the window is thinned in the end.
TEST_F(ThindTest, AWindowInterruptedFromOutsideStaysInPlay) {
  site_.daemon["max_interruptions"] = "2";
  const std::string flag = site_.path("flag").string();
  site_.deliver("a.txt", soundings(0));
  site_.deliver("b.txt", soundings(1, 3, "do window wait-for " + flag + "\n"));
  for (int death = 0; death < 2; ++death) {
    const std::size_t log_before = site_.log().size();
    Process daemon = site_.start();
    ASSERT_TRUE(wait_until([&] {
      return site_.log().find(" watches ", log_before) != std::string::npos &&
             site_.status()["windows"][0]["attempts"] == 1;
    }));
    daemon.signal(SIGKILL);
    daemon.wait();
  }
  write_content(flag, "");
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 2);
  EXPECT_EQ(site_.quarantined(), 0);
}

TEST_F(ThindTest, TemporaryTroubleNeverQuarantines) {
  const std::string flag = site_.path("flag").string();
  site_.deliver("a.txt", soundings(0, 3, "do ingest temporary-until " + flag + "\n"));
  EXPECT_EQ(site_.run_once(), 75);
  EXPECT_EQ(site_.pending(), 1);
  EXPECT_EQ(site_.run_once(), 75);
  EXPECT_TRUE(site_.consistent());
  Process daemon = site_.start();
  write_content(flag, "");
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow); }));
  EXPECT_EQ(site_.quarantined(), 0);
}

TEST_F(ThindTest, AnEmptyWindowIsRecordedWithoutOutput) {
  site_.daemon["max_windows_per_file"] = "9";
  // Two observations nine hours apart: the windows between have none.
  site_.deliver("a.txt", "SOUNDINGS\nobs " + std::to_string(kBeginMs) + " 3\nobs " +
                             std::to_string(kBeginMs + 540 * kMinuteMs) + " 3\nEND\n");
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.outbox().size(), 4U);
  EXPECT_EQ(site_.status()["windows"][1]["state"], "empty");
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, TheSameContentAgainIsADuplicate) {
  site_.deliver("a.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  const auto before = site_.outbox();
  site_.deliver("a.txt", soundings(0));
  site_.deliver("other name.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.outbox(), before);
  EXPECT_EQ(site_.status()["files"]["duplicates"], 2);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_TRUE(there("archive/other name.txt"));
  EXPECT_FALSE(there("inbox/a.txt"));
}

TEST_F(ThindTest, OtherContentOfANameIsAnotherFile) {
  site_.deliver("a.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  site_.deliver("a.txt", soundings(400));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 2);
  EXPECT_EQ(content_of(site_.path("archive/a.txt")), soundings(0));
  EXPECT_EQ(files_below(site_.path("archive")).size(), 2U);
}

TEST_F(ThindTest, AQuarantinedFileThatComesAgainIsTriedAgain) {
  const std::string flag = site_.path("flag").string();
  site_.deliver("a.txt", soundings(0, 3, "do ingest once " + flag + "\n"));
  site_.daemon["max_attempts"] = "1";
  EXPECT_EQ(site_.run_once(), 3);
  ASSERT_TRUE(there("quarantine/a.txt"));
  std::filesystem::rename(site_.path("quarantine/a.txt"), site_.path("inbox/a.txt"));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_EQ(site_.quarantined(), 0);
  EXPECT_TRUE(files_below(site_.path("quarantine")).empty()) << "its reason is no longer true";
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, TruncatedFilesWaitAndAreCompletedByAppending) {
  const std::string whole = soundings(0);
  const auto in_inbox = site_.path("inbox/a.txt");
  site_.window["cutoff_minutes"] = "99999999";  // no window closes
  Process daemon = start_and_see();
  write_content(in_inbox, whole.substr(0, 50));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("is incomplete"); }));
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(in_inbox); })) << "back where its sender looks for it";
  EXPECT_EQ(site_.pending(), 1);
  std::ofstream(in_inbox, std::ios::app) << whole.substr(50);
  ASSERT_TRUE(wait_until([&] { return site_.log_says("a.txt staged"); }));
  const nlohmann::json files = site_.status()["files"];
  EXPECT_EQ(files["seen"], 1) << "the beginning is not content of its own";
  EXPECT_EQ(files["quarantined"], 0);
}

TEST_F(ThindTest, AWriterWhoPausesWithTheFileOpenLosesNothing) {
  const std::string whole = soundings(0);
  Process daemon = start_and_see();
  std::ofstream writing(site_.path("inbox/a.txt"));
  writing << whole.substr(0, 50) << std::flush;
  ASSERT_TRUE(wait_until([&] { return site_.log_says("is incomplete"); }));
  writing << whole.substr(50) << std::flush;
  ASSERT_TRUE(wait_until([&] { return there("archive/a.txt"); }));
  EXPECT_EQ(content_of(site_.path("archive/a.txt")), whole);
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, ASenderMaySendATruncatedFileAgain) {
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0).substr(0, 50));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("is incomplete"); }));
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow); }));
  EXPECT_TRUE(wait_until([&] { return site_.pending() == 0; }));
  EXPECT_EQ(site_.published(), 1);
  EXPECT_EQ(site_.quarantined(), 0);
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, IncompleteFilesAreQuarantinedAfterTheWait) {
  site_.daemon["max_wait_seconds"] = "0.5";
  Process daemon = start_and_see();
  site_.deliver("cut.txt", soundings(0).substr(0, 50));
  site_.deliver("empty.txt", "");
  ASSERT_TRUE(wait_until([&] { return there("quarantine/cut.txt.reason.json"); }));
  ASSERT_TRUE(wait_until([&] { return there("quarantine/empty.txt.reason.json"); }));
  EXPECT_NE(reason("cut.txt")["reason"].get<std::string>().find("stayed incomplete"), std::string::npos);
  EXPECT_NE(reason("empty.txt")["reason"].get<std::string>().find("is empty"), std::string::npos);
  site_.deliver("empty2.txt", "");
  EXPECT_TRUE(wait_until([&] { return there("quarantine/empty2.txt.reason.json"); }));
  EXPECT_TRUE(wait_until([&] { return site_.consistent() && site_.pending() == 0; }));
}

TEST_F(ThindTest, AnIncompleteFileThatItsSenderRemovesIsForgotten) {
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0).substr(0, 50));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("is incomplete") && there("inbox/a.txt"); }));
  std::filesystem::remove(site_.path("inbox/a.txt"));
  EXPECT_TRUE(wait_until([&] { return site_.log_says("was withdrawn"); }));
  EXPECT_EQ(site_.status()["files"]["withdrawn"], 1);
  EXPECT_EQ(site_.pending(), 0);
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, WhatIsNoFileStaysAndBlocksNothing) {
  ASSERT_EQ(::mkfifo(site_.path("inbox/fifo").c_str(), 0600), 0);
  std::filesystem::create_directory(site_.path("inbox/folder"));
  std::filesystem::create_symlink("/etc/passwd", site_.path("inbox/link"));
  write_content(site_.path("inbox/.hidden"), soundings(0));
  write_content(site_.path("inbox/a.txt.tmp"), soundings(1));
  site_.deliver("good.txt", soundings(0, 4));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 1);
  for (const char* name : {"fifo", "folder", "link", ".hidden", "a.txt.tmp"})
    EXPECT_TRUE(there(std::string("inbox/") + name));
  for (const char* name : {"fifo", "folder", "link"})
    EXPECT_TRUE(site_.log_says(std::string(name) + " stays in the inbox"));
}

TEST_F(ThindTest, AwkwardNamesAreNamesToo) {
  for (const std::string& name : {std::string("line\nbreak"), std::string("\xff\xfe.bufr"), std::string("-rf"),
                                  std::string("report.json"), std::string(250, 'n'), std::string("a b'\"$(x)")})
    site_.deliver(name.substr(0, 250), soundings(static_cast<int>(name.size())));
  site_.daemon["log_format"] = "\"json\"";
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 6);
  EXPECT_EQ(files_below(site_.path("archive")).size(), 6U);
  EXPECT_EQ(site_.outbox().size(), 6U + 2) << "six outputs, and the reports of two windows";
  std::istringstream lines(site_.log());
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
}

TEST_F(ThindTest, NoticesFilesAsTheyComeAndRests) {
  site_.daemon["rescan_seconds"] = "1000";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow); }));
  write_content(site_.path("inbox/b.txt"), soundings(200));
  ASSERT_TRUE(wait_until([&] { return there("outbox/20260101T030000Z-20260101T060000Z"); }));
  // With nothing to do it does nothing: no processor time over a look at a clock that others drive.
  const auto ticks = [&] {
    std::istringstream stat(content_of("/proc/" + std::to_string(daemon.number()) + "/stat"));
    std::string word;
    long used = 0;
    for (int i = 1; stat >> word && i < 15; ++i)
      if (i == 14) used = std::stol(word);
    return used;
  };
  const long before = ticks();
  const auto begin = std::chrono::steady_clock::now();
  wait_until([&] { return std::chrono::steady_clock::now() - begin > std::chrono::seconds(1); });
  EXPECT_LE(ticks() - before, 5) << "of 100 in that second";
}

TEST_F(ThindTest, PollingFindsFilesToo) {
  site_.daemon["poll_only"] = "true";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  EXPECT_TRUE(wait_until([&] { return there("outbox/" + kWindow); }));
}

TEST_F(ThindTest, WindowsWaitForTheCutOff) {
  site_.window["cutoff_minutes"] = "99999999";
  site_.window["expected_platforms"] = "[\"3\", \"4\"]";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0, 3));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("a.txt staged"); }));
  site_.deliver("x.txt", soundings(400, 5));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("x.txt staged"); }));
  EXPECT_TRUE(site_.outbox().empty());
  site_.deliver("b.txt", soundings(1, 4));
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow); })) << "all expected platforms are there";
  EXPECT_EQ(site_.outbox().count(kWindow + "/b.txt"), 1U);
  EXPECT_EQ(site_.status()["windows"][1]["state"], "open");
}

TEST_F(ThindTest, LateDataIsThinnedAgainWithTheWindow) {
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return there("archive/a.txt"); }));
  site_.deliver("b.txt", soundings(1));
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow + ".v2"); }));
  EXPECT_EQ(site_.outbox().count(kWindow + ".v2/a.txt"), 1U);
  EXPECT_EQ(site_.outbox().count(kWindow + ".v2/b.txt"), 1U);
  EXPECT_TRUE(wait_until([&] { return site_.published() == 2; }));
  EXPECT_TRUE(wait_until([&] { return files_below(site_.path("state/staged")).empty(); }));
}

TEST_F(ThindTest, LateDataIsThinnedSeparately) {
  site_.window["late"] = "\"separate\"";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return there("archive/a.txt"); }));
  site_.deliver("b.txt", soundings(1));
  ASSERT_TRUE(wait_until([&] { return there("outbox/" + kWindow + ".late1"); }));
  EXPECT_EQ(site_.outbox().count(kWindow + ".late1/a.txt"), 0U);
  EXPECT_EQ(site_.outbox().count(kWindow + ".late1/b.txt"), 1U);
}

TEST_F(ThindTest, LateDataIsKeptApartWhereItIsDropped) {
  site_.window["late"] = "\"drop\"";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return there("archive/a.txt"); }));
  site_.deliver("b.txt", soundings(1));
  ASSERT_TRUE(wait_until([&] { return there("late/b.txt"); }));
  EXPECT_EQ(site_.outbox().size(), 2U);
  EXPECT_TRUE(wait_until([&] { return site_.published() == 2; }));
  EXPECT_EQ(site_.status()["windows"][0]["late_dropped"], 1);
}

TEST_F(ThindTest, PerFileModePublishesEachByItself) {
  site_.window["mode"] = "\"per_file\"";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  site_.deliver("b.txt", soundings(0, 4));
  ASSERT_TRUE(wait_until([&] { return there("archive/a.txt") && there("archive/b.txt"); }));
  site_.deliver("a.txt", soundings(3));
  ASSERT_TRUE(wait_until([&] { return site_.published() == 3; }));
  const auto outbox = site_.outbox();
  EXPECT_EQ(outbox.size(), 6U);
  EXPECT_EQ(outbox.count("a.txt"), 1U);
  EXPECT_EQ(outbox.count("b.txt"), 1U);
  EXPECT_EQ(outbox.count("reports/a.txt.json"), 1U);
}

TEST_F(ThindTest, SigtermLetsWorkersFinish) {
  const std::string flag = site_.path("flag").string();
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0, 3, "do window wait-for " + flag + "\n"));
  ASSERT_TRUE(wait_until([&] { return there("outbox/.tmp-window-1"); }));
  daemon.signal(SIGTERM);
  ASSERT_TRUE(wait_until([&] { return site_.log_says("stopping"); }));
  write_content(flag, "");
  EXPECT_EQ(daemon.wait(), 143);
  EXPECT_TRUE(there("outbox/" + kWindow + "/a.txt"));
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, SigtermAbandonsWorkersThatDoNot) {
  const std::string flag = site_.path("flag").string();
  site_.daemon["stop_timeout_seconds"] = "0.2";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0, 3, "do window wait-for " + flag + "\n"));
  ASSERT_TRUE(wait_until([&] { return there("outbox/.tmp-window-1"); }));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 143);
  EXPECT_FALSE(there("outbox/" + kWindow)) << "nothing half-published";
  EXPECT_TRUE(site_.outbox().empty());
  EXPECT_EQ(site_.pending(), 1);
  EXPECT_EQ(site_.status()["windows"][0]["attempts"], 0) << "the file is not to blame";
  write_content(flag, "");
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, SighupTakesOverAGoodConfiguration) {
  site_.window["cutoff_minutes"] = "99999999";
  Process daemon = start_and_see();
  site_.deliver("a.txt", soundings(0));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("a.txt staged"); }));
  site_.window["cutoff_minutes"] = "0";
  site_.write_config();
  daemon.signal(SIGHUP);
  EXPECT_TRUE(wait_until([&] { return there("outbox/" + kWindow); }));
  EXPECT_TRUE(site_.log_says("the new configuration holds"));
}

TEST_F(ThindTest, SighupRefusesAWrongConfigurationAndSaysWhichLine) {
  Process daemon = start_and_see();
  const std::string good = content_of(site_.path("thind.toml"));
  const auto refused = [&](const std::string& addition, const std::string& words) {
    write_content(site_.path("thind.toml"), good + addition);
    daemon.signal(SIGHUP);
    return wait_until([&] { return site_.log_says(words); });
  };
  EXPECT_TRUE(refused("quiet_secs = 1\n", "thind.toml:10:1: unknown key \"quiet_secs\""));
  EXPECT_TRUE(refused("[thinning]\nfake_problem = 1\n", "a problem that only the worker sees"));
  EXPECT_TRUE(refused("this is no TOML", "thind.toml:10:"));
  site_.deliver("a.txt", soundings(0));
  EXPECT_TRUE(wait_until([&] { return there("outbox/" + kWindow); })) << "the old configuration holds";
  EXPECT_TRUE(site_.log_says("the old configuration holds until SIGHUP"));
}

TEST_F(ThindTest, CheckSaysWhatIsWrong) {
  EXPECT_EQ(site_.start({"--check"}).wait(), 0);
  EXPECT_FALSE(there("state")) << "it only looks";
  site_.rest = "[thinning]\nfake_problem = 1\n";
  EXPECT_EQ(site_.start({"--check"}).wait(), 2);
  EXPECT_TRUE(site_.log_says("thind.toml:11:1: a problem")) << site_.log();
  EXPECT_EQ(site_.start({"--once"}).wait(), 2);
  site_.rest = "[deamon]\n";
  EXPECT_EQ(site_.start({"--check"}).wait(), 2);
  EXPECT_TRUE(site_.log_says("did you mean [daemon]?"));
  EXPECT_EQ(site_.start({"--no-such-option"}).wait(), 2);
}

TEST_F(ThindTest, OneInstancePerInbox) {
  Process daemon = start_and_see();
  EXPECT_EQ(site_.run_once(), 2);
  EXPECT_TRUE(site_.log_says("is held by process " + std::to_string(daemon.number())));
}

TEST_F(ThindTest, TakesUpSpooledContentThatTheJournalLost) {
  std::filesystem::create_directories(site_.path("state/spool"));
  write_content(site_.path("state/spool/something"), soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_EQ(files_below(site_.path("archive")).size(), 1U);
}

TEST_F(ThindTest, WhatWasPublishedButNotJournaledIsFound) {
  site_.deliver("a.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  const auto outbox = site_.outbox();
  // As if it had died between the rename and the journal.
  std::filesystem::remove_all(site_.path("state"));
  std::filesystem::rename(site_.path("archive/a.txt"), site_.path("inbox/a.txt"));
  write_content(site_.path("outbox/.tmp-window-7"), "half");
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.outbox(), outbox);
  EXPECT_EQ(site_.published(), 1);
}

TEST_F(ThindTest, AnInboxOnAnotherFileSystem) {
  struct stat here {
  }, memory{};
  ASSERT_EQ(::stat(site_.path().c_str(), &here), 0);
  if (::stat("/dev/shm", &memory) != 0 || here.st_dev == memory.st_dev) GTEST_SKIP() << "one file system only";
  std::string pattern = "/dev/shm/thind-test-XXXXXX";
  const std::filesystem::path inbox = ::mkdtemp(pattern.data());
  site_.daemon["inbox"] = "\"" + inbox.string() + "\"";
  write_content(inbox / "a.txt", soundings(0));
  write_content(inbox / "cut.txt", soundings(1).substr(0, 50));
  EXPECT_EQ(site_.run_once(), 75);
  EXPECT_EQ(site_.published(), 1);
  EXPECT_TRUE(std::filesystem::exists(inbox / "cut.txt"));
  EXPECT_FALSE(std::filesystem::exists(inbox / "a.txt"));
  EXPECT_TRUE(site_.consistent());
  std::filesystem::remove_all(inbox);
}

TEST_F(ThindTest, TheArchiveIsKeptAsLongAsConfigured) {
  site_.daemon["keep_archive_days"] = "1";
  site_.deliver("a.txt", soundings(0));
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_TRUE(there("archive/a.txt"));
  site_.daemon["keep_archive_days"] = "0";
  EXPECT_EQ(site_.run_once(), 0);
  EXPECT_FALSE(there("archive/a.txt"));
  EXPECT_TRUE(site_.consistent());
}

TEST_F(ThindTest, ManyFilesThroughKillsComeOutAsWithoutThem) {
  Site calm(FAKE_WORKER);
  const unsigned seed = std::random_device()();
  std::printf("seed %u\n", seed);
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto fill = [](Site& site) {
    site.daemon["max_interruptions"] = "1000";
    for (int i = 0; i < 16; ++i) site.deliver("f" + std::to_string(i), soundings(i * 35, i % 3));
    site.deliver("bad", "nothing");
    site.deliver("copy", soundings(0, 0));
  };
  fill(calm);
  EXPECT_EQ(calm.run_once(), 3);
  fill(site_);
  int kills = 0;
  for (int exit_code = -1; exit_code < 0 || exit_code >= 1000;) {
    ASSERT_LT(kills, 200);
    Process daemon = site_.start({"--once"});
    const auto delay = std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 60 + 20 * kills)(random));
    if (!wait_until([&] { return daemon.has_ended(); }, delay)) ++kills, daemon.signal(SIGKILL);
    exit_code = daemon.wait();
    if (std::filesystem::exists(site_.path("state/journal.sqlite")) && site_.status().contains("files")) {
      ASSERT_TRUE(site_.consistent()) << site_.status();
    }
  }
  std::printf("%d kills\n", kills);
  EXPECT_GT(kills, 0);
  EXPECT_EQ(site_.outbox(), calm.outbox());
  EXPECT_EQ(site_.published(), calm.published());
  EXPECT_EQ(site_.quarantined(), calm.quarantined());
  EXPECT_EQ(site_.pending(), 0);
}

}  // namespace
}  // namespace thin::test
