// The steps as programs call them: exit codes, files, and what is printed.

#include <gtest/gtest.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "libthin/formats/observation_file.h"
#include "libthin/thinning/thinning_method.h"
#include "libthin/tools/commands.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/netcdf_files.h"
#include "tests/support/synthetic_files.h"

namespace thin {
namespace {

using Json = nlohmann::json;
using test::kSyntheticBeginMs;
using test::ScratchFolder;

struct Outcome {
  int exit_status;
  std::string output;
};

Outcome call(std::vector<std::string> words) {
  CLI::App program("thin");
  Action action;
  add_run_command(program, action);
  add_check_command(program, action);
  add_ingest_command(program, action);
  add_window_command(program, action);
  add_methods_command(program, action);
  std::reverse(words.begin(), words.end());  // CLI11 takes the words from the back
  program.parse(std::move(words));
  testing::internal::CaptureStdout();
  const int exit_status = action();
  return {exit_status, testing::internal::GetCapturedStdout()};
}

std::string write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

class StepsTest : public testing::Test {
 protected:
  // As main does it: standard output is for what programs read.
  static void SetUpTestSuite() {
    if (!spdlog::get("steps")) spdlog::set_default_logger(spdlog::stderr_logger_mt("steps"));
  }

  ScratchFolder scratch_;
  std::string configuration_ =
      write_text(scratch_.path("c.toml"), "[thinning]\nmethod = \"grid_eea\"\nretain_fraction = 0.2\n");
  std::string good_ = test::write_synthetic_file(scratch_.path("good.bufr"), "NOAA-15", kSyntheticBeginMs, 20);
  std::string bad_ = write_text(scratch_.path("bad.bufr"), "this is no sounding");
  std::string out_ = scratch_.path("out");
};

TEST_F(StepsTest, RunWritesThinnedFilesAndTheReport) {
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", out_, good_}).exit_status, 0);
  EXPECT_TRUE(std::filesystem::exists(out_ + "/good.bufr"));
  const Json report = Json::parse(std::ifstream(out_ + "/report.json"));
  EXPECT_EQ(report["observations"]["retained"], 120);
  EXPECT_EQ(report["satellites"][0]["name"], "NOAA-15");
  EXPECT_EQ(report["configuration"]["thinning.retain_fraction"], "0.2");
  EXPECT_FALSE(report.contains("seconds"));
}

TEST_F(StepsTest, RunExplainsEveryStepAndChangesNothing) {
  const Outcome plain = call({"run", "-c", configuration_, "-o", out_, good_});
  const Outcome explained = call({"run", "--explain", "-c", configuration_, "-o", scratch_.path("out2"), good_});
  EXPECT_EQ(explained.exit_status, 0);
  for (const char* part :
       {"1 read         600 observations of 1 files", "good.bufr: 600 observations, bufr AMSU-A", "2 window",
        "3 duplicates   0 left out", "duplicate_distance_km = 10", "4 screening    0 left out", "surface = []",
        "5 bias", "6 first guess  0 of a file, 600 mean of the scan position",
        "7 thinning     grid_eea: 120 of 600 retained", "retain_fraction = 0.2",
        "8 output       1 files and report.json", "good.bufr: 120 of 600 observations"})
    EXPECT_NE(explained.output.find(part), std::string::npos) << part << "\n" << explained.output;
  for (const char* name : {"/good.bufr", "/report.json"})
    EXPECT_EQ(test::read_bytes(out_ + name), test::read_bytes(scratch_.path("out2") + name));
  EXPECT_EQ(plain.exit_status, 0);
}

TEST_F(StepsTest, RunSaysThreeWhereAFileWasRefusedAndStillThinsTheOthers) {
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", out_, good_, bad_}).exit_status, 3);
  EXPECT_TRUE(std::filesystem::exists(out_ + "/good.bufr"));
  const Json report = Json::parse(std::ifstream(out_ + "/report.json"));
  ASSERT_EQ(report["refused"].size(), 1U);
  EXPECT_EQ(report["refused"][0]["name"], "bad.bufr");
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", out_, bad_}).exit_status, 3);
}

TEST_F(StepsTest, RunRefusesWhatWouldOverwrite) {
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", scratch_.path("."), good_}).exit_status, 2);
  std::filesystem::create_directories(scratch_.path("other"));
  std::filesystem::copy(good_, scratch_.path("other/good.bufr"));
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", out_, good_, scratch_.path("other/good.bufr")}).exit_status, 2);
  EXPECT_EQ(call({"run", "-c", configuration_, "-o", out_, "--begin", "tomorrow", good_}).exit_status, 2);
}

TEST_F(StepsTest, RunTakesInnovationsFromNetcdfAndFlagsWhereAskedTo) {
  const std::string ioda = test::write_ioda(scratch_.path("amsua_n19.nc4"), {.locations = 200});
  const auto settings = [&](const std::string& input) {
    return write_text(scratch_.path("n.toml"),
                      "[thinning]\nmethod = \"box\"\nhorizontal_mesh = 400\n[preparation]\n"
                      "channels = [1, 2]\n" +
                          input);
  };
  ASSERT_EQ(call({"run", "-c", settings(""), "-o", out_, ioda}).exit_status, 0);
  const Json report = Json::parse(std::ifstream(out_ + "/report.json"));
  EXPECT_EQ(report["values"], "innovations");
  EXPECT_EQ(report["files"][0]["notes"][0], "innovations: ObsValue - hofx where PreQC is 0");
  const int retained = report["files"][0]["retained"];
  const auto subset = read_observations(out_ + "/amsua_n19.nc4");
  ASSERT_TRUE(subset.ok()) << subset.error().message;
  EXPECT_EQ(static_cast<int>(subset->observations.size()), retained);

  ASSERT_EQ(call({"run", "-c", settings("[output]\nmode = \"flag\"\n[input]\nioda_quality = []\n"), "-o", out_, ioda})
                .exit_status,
            0);
  const auto flagged = read_observations(out_ + "/amsua_n19.nc4");
  ASSERT_TRUE(flagged.ok()) << flagged.error().message;
  EXPECT_EQ(flagged->observations.size(), 200U);
  EXPECT_EQ(Json::parse(std::ifstream(out_ + "/report.json"))["files"][0]["notes"][0], "innovations: ObsValue - hofx");
}

TEST_F(StepsTest, BufrThatWouldHaveToBeFlaggedIsRefusedBeforeAnyWork) {
  const std::string flags = write_text(scratch_.path("f.toml"),
                                       "[thinning]\nmethod = \"box\"\nhorizontal_mesh = 400\n"
                                       "[preparation]\nchannels = [1, 2]\n[output]\nmode = \"flag\"\n");
  const Outcome ingested = call({"ingest", "-c", flags, "--input", good_, "--output", scratch_.path("s.nc")});
  EXPECT_EQ(ingested.exit_status, exit_code(ErrorKind::input));
  EXPECT_FALSE(std::filesystem::exists(scratch_.path("s.nc")));
  const std::string ioda = test::write_ioda(scratch_.path("amsua_n19.nc4"), {.locations = 200});
  EXPECT_EQ(call({"run", "-c", flags, "-o", out_, good_, ioda}).exit_status, exit_code(ErrorKind::input));
  const Json report = Json::parse(std::ifstream(out_ + "/report.json"));
  ASSERT_EQ(report["refused"].size(), 1U);
  EXPECT_NE(report["refused"][0]["reason"].get<std::string>().find("mode = \"subset\""), std::string::npos);
}

TEST_F(StepsTest, RunSaysTwoForABadConfiguration) {
  const std::string wrong = write_text(scratch_.path("w.toml"), "[thinning]\nmethod = \"grid_eea\"\n");
  EXPECT_EQ(call({"run", "-c", wrong, "-o", out_, good_}).exit_status, 2);
  EXPECT_EQ(call({"check", "-c", wrong}).exit_status, 2);
  EXPECT_EQ(call({"check", "-c", scratch_.path("nowhere")}).exit_status, 2);
  EXPECT_EQ(call({"check", "-c", configuration_}).exit_status, 0);
}

TEST_F(StepsTest, IngestThenWindowGivesTheBytesOfRun) {
  const std::string staged = scratch_.path("staged.nc");
  const Outcome ingested = call({"ingest", "-c", configuration_, "--input", good_, "--output", staged});
  ASSERT_EQ(ingested.exit_status, 0);
  const Json said = Json::parse(ingested.output);
  EXPECT_EQ(said["outcome"], "staged");
  EXPECT_EQ(said["observations"], 600);
  EXPECT_EQ(said["time_begin_ms"], kSyntheticBeginMs);
  EXPECT_EQ(said["platforms"][0]["number"], 206);

  const Json plan = {{"begin_ms", nullptr},
                     {"end_ms", nullptr},
                     {"files", {{{"name", "good.bufr"}, {"original", good_}, {"staged", staged}}}}};
  const std::string plan_path = write_text(scratch_.path("plan.json"), plan.dump());
  std::filesystem::create_directories(scratch_.path("window"));
  const Outcome thinned =
      call({"window", "-c", configuration_, "--plan", plan_path, "--output", scratch_.path("window")});
  ASSERT_EQ(thinned.exit_status, 0);
  const Json done = Json::parse(thinned.output);
  EXPECT_EQ(done["outcome"], "done");
  EXPECT_EQ(done["outputs"][0]["bytes"], std::filesystem::file_size(scratch_.path("window/good.bufr")));

  ASSERT_EQ(call({"run", "-c", configuration_, "-o", out_, good_}).exit_status, 0);
  for (const char* name : {"/good.bufr", "/report.json"})
    EXPECT_EQ(test::read_bytes(scratch_.path("window") + name), test::read_bytes(out_ + name)) << name;
}

TEST_F(StepsTest, IngestSaysWhatIsWrong) {
  const Outcome refused = call({"ingest", "--input", bad_, "--output", scratch_.path("s.nc")});
  EXPECT_EQ(refused.exit_status, 3);
  EXPECT_EQ(Json::parse(refused.output)["outcome"], "unusable");
  EXPECT_EQ(Json::parse(refused.output)["reason"].get<std::string>().find(bad_), std::string::npos) << refused.output;
  EXPECT_FALSE(std::filesystem::exists(scratch_.path("s.nc")));

  test::ByteVector cut = test::read_bytes(good_);
  cut.resize(cut.size() / 2);
  const Outcome incomplete =
      call({"ingest", "--input", scratch_.write("cut.bufr", cut), "--output", scratch_.path("s.nc")});
  EXPECT_EQ(incomplete.exit_status, 75);
  EXPECT_EQ(Json::parse(incomplete.output)["outcome"], "incomplete");
}

TEST_F(StepsTest, WindowRefusesABrokenPlan) {
  const std::string plan = write_text(scratch_.path("plan.json"), "{\"files\": [{\"name\": 7}]}");
  EXPECT_EQ(call({"window", "-c", configuration_, "--plan", plan, "--output", scratch_.path(".")}).exit_status, 2);
}

TEST_F(StepsTest, WindowFailsAtADamagedStagedFileAndDoesNotCallItEmpty) {
  const Json plan = {{"files", {{{"name", "good.bufr"}, {"original", good_}, {"staged", bad_}}}}};
  const std::string plan_path = write_text(scratch_.path("plan.json"), plan.dump());
  const Outcome outcome = call({"window", "-c", configuration_, "--plan", plan_path, "--output", scratch_.path(".")});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_EQ(Json::parse(outcome.output)["outcome"], "error");
}

TEST_F(StepsTest, MethodsAreListedFromTheirDeclarations) {
  const Outcome all = call({"methods", "--json"});
  EXPECT_EQ(all.exit_status, 0);
  const Json methods = Json::parse(all.output);
  EXPECT_EQ(methods.size(), thinning_methods().size());
  for (const Json& method : methods)
    for (const Json& option : method["options"]) EXPECT_NE(option["explanation"], "") << option["name"];
  EXPECT_EQ(call({"methods", "nonsense"}).exit_status, 2);
}

}  // namespace
}  // namespace thin
