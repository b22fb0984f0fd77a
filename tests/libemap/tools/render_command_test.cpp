#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libemap/rendering/image.h"
#include "libemap/surface/model_file.h"
#include "libemap/tools/commands.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

namespace fs = std::filesystem;

class RenderCommandTest : public testing::Test {
 protected:
  struct Ran {
    int code;
    std::string output, error;
  };

  void SetUp() override {
    fs::create_directories(folder_);
    ASSERT_TRUE(write_ply(path("waves.ply"), test::waves(30)));
    ASSERT_EQ(run({"encode", path("waves.ply"), path("waves.emap"), "--psnr", "60", "--quiet"}).code, 0);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ / name; }

  static Ran run(const std::vector<std::string>& words) {
    CLI::App program;
    Action action;
    add_encode_command(program, action);
    add_render_command(program, action);
    try {
      program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
      return {2, "", error.what()};
    }
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = action();
    std::string output = testing::internal::GetCapturedStdout();
    return {code, output, testing::internal::GetCapturedStderr()};
  }

  Ran render(const std::string& input, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"render", path(input), path("out.png")};
    const auto give = [&](const std::string& option, const std::string& value) {
      if (std::find(options.begin(), options.end(), option) == options.end())
        words.insert(words.end(), {option, value});
    };
    give("--size", "40x30");
    give("--camera", "0,20,2");
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }

 private:
  fs::path folder_ = fs::path(testing::TempDir()) / ("emap_render_" + std::to_string(::getpid()));
};

TEST_F(RenderCommandTest, EveryModeWritesAPicture) {
  for (const std::string mode : {"mesh", "splats", "splats-blended", "splats-interpolated"}) {
    ASSERT_EQ(render("waves.emap", {"--mode", mode}).code, 0) << mode;
    const auto image = read_png(path("out.png"));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 40);
    EXPECT_EQ(image->height, 30);
    EXPECT_LT(image->pixel(20, 15)[0], 255);
    EXPECT_EQ(image->pixel(0, 0)[0], 255);
  }
  EXPECT_EQ(render("waves.ply", {"--mode", "mesh"}).code, 0);
  EXPECT_EQ(render("waves.ply", {"--mode", "splats"}).code, 0);
}

TEST_F(RenderCommandTest, ATurntableIsNumbered) {
  ASSERT_EQ(render("waves.emap", {"--turntable", "3"}).code, 0);
  for (const char* name : {"out-000.png", "out-001.png", "out-002.png"}) EXPECT_TRUE(fs::exists(path(name)));
  EXPECT_FALSE(fs::exists(path("out.png")));
}

TEST_F(RenderCommandTest, ABenchReportsInJson) {
  const Ran ran = run({"render", path("waves.emap"), "--size", "32x32", "--bench", "0.05", "--json"});
  ASSERT_EQ(ran.code, 0);
  const auto json = nlohmann::json::parse(ran.output);
  EXPECT_GT(json["frames_per_second"], 0);
  EXPECT_GT(json["bytes"], 0);
  EXPECT_GT(json["samples"], 0);
  EXPECT_FALSE(json["renderer"].get<std::string>().empty());
}

TEST_F(RenderCommandTest, WhatIsWrongIsSaid) {
  std::ofstream(path("damaged.emap")) << "EMAP and then nothing of use, long enough to be read as a header, perhaps";
  std::ofstream(path("empty.xyz")) << "";
  std::ofstream(path("one.xyz")) << "1 2 3\n";
  struct Case {
    Ran ran;
    int code;
    std::string says;
  };
  const std::vector<Case> cases = {
      {render("damaged.emap"), 3, "damaged.emap"},
      {render("missing.emap"), 3, "missing.emap"},
      {render("empty.xyz", {"--mode", "splats"}), 3, "empty.xyz"},
      {render("one.xyz", {"--mode", "splats"}), 3, "empty"},
      {render("waves.ply", {"--mode", "splats-interpolated"}), 2, "emap encode"},
      {render("waves.emap", {"--size", "1000000x10"}), 2, "1000000 x 10"},
      {render("waves.emap", {"--size", "large"}), 2, "WIDTHxHEIGHT"},
      {render("waves.emap", {"--camera", "up"}), 2, "no camera"},
      {render("waves.emap", {"--backend", "glx"}), 2, "backend"},
      {render("waves.emap", {"--texture", path("damaged.emap")}), 3, "no PNG"},
      {run({"render", path("waves.emap")}), 2, "--bench"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(one.ran.code, one.code) << one.says << ": " << one.ran.error;
    // The test's logger may write to either.
    const std::string said = one.ran.output + one.ran.error;
    EXPECT_NE(said.find(one.says), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace emap
