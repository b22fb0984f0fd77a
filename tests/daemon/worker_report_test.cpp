#include "daemon/worker_report.h"

#include <gtest/gtest.h>
#include <signal.h>

namespace thind {
namespace {

WorkerExit exited(int code, const std::string& output = "") {
  WorkerExit exit;
  exit.exit_code = code;
  exit.output = output;
  return exit;
}

const char* const kStaged =
    R"({"outcome":"staged","observations":3,"time_begin_ms":-5,"time_end_ms":9,"platforms":[{"number":4},{"number":3}],
        "skipped":[{"message":1}]})";
const char* const kDone =
    R"({"outcome":"done","observations":9,"retained":3,"outputs":[{"name":"a","bytes":7,"retained":3}],
        "seconds":{"thin":0.5},"report":"report.json"})";

TEST(WorkerReport, ReadsWhatIngestSays) {
  const IngestReport report = read_ingest_report(exited(0, kStaged));
  EXPECT_EQ(report.outcome, Outcome::done);
  EXPECT_EQ(report.staged.observations, 3);
  EXPECT_EQ(report.staged.first_ms, -5);
  EXPECT_EQ(report.staged.last_ms, 9);
  EXPECT_EQ(report.staged.platforms, (std::vector<int>{4, 3}));
  EXPECT_EQ(report.skipped, 1);
}

TEST(WorkerReport, ReadsWhatWindowSays) {
  const WindowReport report = read_window_report(exited(0, kDone));
  EXPECT_EQ(report.outcome, Outcome::done);
  EXPECT_EQ(report.retained, 3);
  ASSERT_EQ(report.outputs.size(), 1U);
  EXPECT_EQ(report.outputs[0].name, "a");
  EXPECT_EQ(report.outputs[0].bytes, 7);
  EXPECT_EQ(report.seconds, R"({"thin":0.5})");
}

TEST(WorkerReport, ExitStatusDecides) {
  EXPECT_EQ(read_ingest_report(exited(1)).outcome, Outcome::failed);
  EXPECT_EQ(read_ingest_report(exited(2)).outcome, Outcome::configuration);
  EXPECT_EQ(read_ingest_report(exited(3)).outcome, Outcome::unusable);
  EXPECT_EQ(read_ingest_report(exited(75)).outcome, Outcome::temporary);
  EXPECT_EQ(read_ingest_report(exited(75, R"({"outcome":"incomplete","reason":"cut"})")).outcome, Outcome::incomplete);
  EXPECT_EQ(read_ingest_report(exited(143)).outcome, Outcome::stopped);
  EXPECT_EQ(read_ingest_report(exited(kExitNotStarted)).outcome, Outcome::temporary);
  EXPECT_EQ(read_ingest_report(exited(42)).outcome, Outcome::failed);
  EXPECT_EQ(read_ingest_report(exited(1, kStaged)).outcome, Outcome::failed) << "whatever it says";
}

TEST(WorkerReport, SignalsAreTheInputsMakingUnlessTheyWereOurs) {
  WorkerExit exit;
  exit.signal = SIGSEGV;
  EXPECT_EQ(read_ingest_report(exit).outcome, Outcome::failed);
  exit.signal = SIGTERM;
  EXPECT_EQ(read_ingest_report(exit).outcome, Outcome::stopped);
  exit.signal = SIGKILL;
  EXPECT_EQ(read_ingest_report(exit).outcome, Outcome::failed) << "out of memory";
  exit.stopped = true;
  EXPECT_EQ(read_ingest_report(exit).outcome, Outcome::stopped);
}

TEST(WorkerReport, WordsThatMakeNoSenseAreAFailure) {
  for (const char* words : {"", "{", "[]", "null", "{\"observations\":\"three\"}", "\xff\x00", "{} {}",
                            R"({"observations":1,"time_begin_ms":9,"time_end_ms":8,"platforms":[]})",
                            R"({"observations":0,"time_begin_ms":1,"time_end_ms":2,"platforms":[]})",
                            R"({"observations":1,"time_begin_ms":1,"time_end_ms":2,"platforms":[7]})",
                            R"({"observations":1,"time_begin_ms":1,"time_end_ms":2,"platforms":7})"}) {
    const IngestReport report = read_ingest_report(exited(0, words));
    EXPECT_EQ(report.outcome, Outcome::failed) << words;
    EXPECT_FALSE(report.reason.empty());
    EXPECT_EQ(read_window_report(exited(0, words)).outcome, Outcome::failed) << words;
  }
}

TEST(WorkerReport, GivesAReasonInASentence) {
  EXPECT_EQ(read_ingest_report(exited(3, R"({"outcome":"unusable","reason":"no soundings"})")).reason, "no soundings");
  WorkerExit exit = exited(1);
  exit.last_errors = "first\nsecond\n\n";
  EXPECT_EQ(read_ingest_report(exit).reason, "the worker exited with 1: second");
  exit.exit_code.reset();
  exit.signal = SIGSEGV;
  EXPECT_EQ(read_ingest_report(exit).reason, "the worker was ended by signal 11 (Segmentation fault): second");
  exit.signal = SIGKILL;
  exit.timed_out = true;
  exit.seconds = 2;
  EXPECT_EQ(describe(exit), "ran longer than allowed and was ended after 2.0 s");
}

}  // namespace
}  // namespace thind
