#include "daemon/supervisor.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

using thin::test::wait_until;

WorkerExit run_shell(const std::string& script, WorkerLimits limits = {.wall_seconds = 60}) {
  const auto exit = run_worker({{"/bin/sh", "-c", script}, limits});
  EXPECT_TRUE(exit);
  return exit ? *exit : WorkerExit();
}

bool is_alive(pid_t process) {
  // A zombie that nobody has fetched yet is dead.
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return static_cast<bool>(stat >> number >> name >> state) && state != "Z";
}

TEST(Supervisor, HearsTheWorkerToItsEnd) {
  const WorkerExit exit = run_shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(exit.exit_code, 3);
  EXPECT_FALSE(exit.signal);
  EXPECT_EQ(exit.output, "out\n");
  EXPECT_EQ(exit.last_errors, "err\n");
}

TEST(Supervisor, SaysWhichSignal) {
  const WorkerExit exit = run_shell("kill -SEGV $$");
  EXPECT_FALSE(exit.exit_code);
  EXPECT_EQ(exit.signal, SIGSEGV);
  EXPECT_FALSE(exit.timed_out);
}

TEST(Supervisor, EndsWhatRunsTooLong) {
  const WorkerExit exit = run_shell("echo started; sleep 1000", {.wall_seconds = 0.2});
  EXPECT_TRUE(exit.timed_out);
  EXPECT_EQ(exit.signal, SIGKILL);
  EXPECT_EQ(exit.output, "started\n");
  EXPECT_LT(exit.seconds, 60);
}

TEST(Supervisor, IgnoredSignalsDoNotHelp) {
  EXPECT_TRUE(run_shell("trap '' TERM INT HUP; while :; do sleep 1; done", {.wall_seconds = 0.2}).timed_out);
}

TEST(Supervisor, TakesDescendantsAlong) {
  const WorkerExit exit = run_shell("sleep 1000 & echo $!");
  EXPECT_EQ(exit.exit_code, 0);
  const pid_t descendant = std::stoi(exit.output);
  EXPECT_TRUE(wait_until([&] { return !is_alive(descendant); }));
}

TEST(Supervisor, BoundsWhatItKeeps) {
  const WorkerExit loud = run_shell("head -c 9000000 /dev/zero; head -c 100000 /dev/zero >&2; echo end >&2");
  EXPECT_EQ(loud.exit_code, 0);
  EXPECT_EQ(loud.output.size(), kOutputBytes);
  EXPECT_TRUE(loud.output_cut);
  EXPECT_EQ(loud.last_errors.size(), kErrorBytes);
  EXPECT_EQ(loud.last_errors.substr(kErrorBytes - 4), "end\n");
}

TEST(Supervisor, AChattererCannotHoldIt) {
  const WorkerExit exit = run_shell("yes", {.wall_seconds = 0.3});
  EXPECT_TRUE(exit.timed_out);
  EXPECT_EQ(exit.output.size(), kOutputBytes);
}

TEST(Supervisor, SaysThatAProgramIsNotThere) {
  const auto exit = run_worker({{"/no/such/program"}, {}});
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->exit_code, kExitNotStarted);
  EXPECT_NE(exit->last_errors.find("/no/such/program"), std::string::npos);
}

TEST(Supervisor, SetsLimits) {
  EXPECT_EQ(run_shell("ulimit -v; ulimit -f; ulimit -c; ulimit -t",
                      {.wall_seconds = 60, .memory_bytes = 1 << 30, .cpu_seconds = 77, .file_bytes = 1 << 20})
                .output,
            "1048576\n2048\n0\n77\n");
  EXPECT_EQ(run_shell("cat; grep NoNewPrivs /proc/self/status").output, "NoNewPrivs:\t1\n") << "and no input";
}

TEST(Supervisor, RunsSeveralAndTellsThemApart) {
  Supervisor supervisor;
  std::map<Supervisor::Key, int> expected;
  for (int code = 0; code < 5; ++code)
    expected[*supervisor.start({{"/bin/sh", "-c", "exit " + std::to_string(code)}, {}})] = code;
  EXPECT_EQ(supervisor.running(), 5U);
  std::map<Supervisor::Key, int> codes;
  EXPECT_TRUE(wait_until([&] {
    for (auto& [key, exit] : supervisor.collect()) codes[key] = exit.exit_code.value_or(-1);
    return supervisor.running() == 0;
  }));
  EXPECT_EQ(codes, expected);
}

TEST(Supervisor, StopsAllAndSaysSo) {
  Supervisor supervisor;
  ASSERT_TRUE(supervisor.start({{"/bin/sleep", "1000"}, {}}));
  ASSERT_TRUE(supervisor.collect().empty());
  supervisor.stop_all(SIGKILL);
  std::vector<std::pair<Supervisor::Key, WorkerExit>> ended;
  EXPECT_TRUE(wait_until([&] { return !(ended = supervisor.collect()).empty(); }));
  EXPECT_TRUE(ended[0].second.stopped);
  EXPECT_FALSE(ended[0].second.timed_out);
}

TEST(Supervisor, LeavesNothingBehind) {
  pid_t process = 0;
  {
    Supervisor supervisor;
    thin::test::TemporaryFolder folder;
    const std::string file = (folder.path() / "pid").string();
    ASSERT_TRUE(supervisor.start({{"/bin/sh", "-c", "echo $$ > " + file + "; exec sleep 1000"}, {}}));
    ASSERT_TRUE(wait_until([&] { return thin::test::content_of(file).ends_with('\n'); }));
    process = std::stoi(thin::test::content_of(file));
    EXPECT_TRUE(is_alive(process));
  }
  EXPECT_FALSE(is_alive(process));
}

}  // namespace
}  // namespace thind
