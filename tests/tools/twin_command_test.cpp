#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "libthin/tools/commands.h"
#include "libthin/tools/twin_settings.h"

namespace thin {
namespace {

constexpr const char* kSmall = R"(
[twin]
satellites = ["NOAA-16"]
window_minutes = 12
step = 2
counts = [40]
cases = 2
methods = ["box"]
[[twin.variant]]
label = "removal"
method = "eea"
bandwidth_km = 80
)";

class TwinCommand : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "thin-twin-XXXXXX").string();
    ASSERT_TRUE(::mkdtemp(pattern.data()));
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  int twin(const std::string& configuration) {
    std::ofstream(folder_ / "c.toml") << configuration;
    CLI::App program("thin");
    Action action;
    add_twin_command(program, action);
    std::vector<std::string> words = {"twin", "-c", path("c.toml"), "--json", path("r.json")};
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    testing::internal::CaptureStdout();
    const int code = action();
    output_ = testing::internal::GetCapturedStdout();
    return code;
  }
  nlohmann::json json() const {
    std::ifstream file(folder_ / "r.json");
    return nlohmann::json::parse(file);
  }

  std::filesystem::path folder_;
  std::string output_;
};

TEST_F(TwinCommand, WritesATableAndJson) {
  ASSERT_EQ(twin(kSmall), 0);
  EXPECT_NE(output_.find("removal"), std::string::npos) << output_;
  const auto result = json();
  ASSERT_EQ(result["scores"].size(), 6U);  // background, all, even, random, and two variants
  EXPECT_EQ(result["scores"][0]["set"], "background");
  EXPECT_EQ(result["scores"][5]["set"], "box");
  EXPECT_EQ(result["scores"][4]["retained"], (std::vector<double>{40, 40}));
  EXPECT_EQ(result["configuration"]["twin.cases"], "2");
  for (const auto& error : result["scores"][1]["tuned"]) EXPECT_LT(error.get<double>(), 1);
}

TEST_F(TwinCommand, CyclesWhereAskedTo) {
  const std::string cycle = R"(
[cycle]
cycles = 3
spin_up_cycles = 1
grid_deg = 9
observation_step = 6
count = 40
forecast_days = 1
forecast_every = 1
)";
  ASSERT_EQ(twin(kSmall + cycle), 0);
  const auto result = json();
  ASSERT_EQ(result["sets"].size(), 6U);
  EXPECT_EQ(result["sets"][4]["set"], "removal");
  EXPECT_EQ(result["sets"][4]["analysis_error_k"].size(), 2U);
  EXPECT_EQ(result["sets"][4]["anomaly_correlation"]["global"].size(), 2U);
}

TEST_F(TwinCommand, WhatDoesNotFitIsAnError) {
  EXPECT_EQ(twin("[twin]\ncases = 0\n"), 2);
  EXPECT_EQ(twin("[twin]\nsatellites = [\"NOAA-1\"]\n"), 2);
  EXPECT_EQ(twin("[twin]\nbegin = \"soon\"\n"), 2);
  EXPECT_EQ(twin("[cycle]\ncycles = 2\nhours = 7\n"), 2);
  EXPECT_EQ(twin("[twin]\nmethods = [\"nonesuch\"]\n"), 2);
}

}  // namespace
}  // namespace thin
