#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "libemap/page/page.h"
#include "libemap/surface/model_file.h"
#include "libemap/surface/surface_distance.h"
#include "libemap/tools/commands.h"
#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

namespace fs = std::filesystem;

struct Ran {
  int code;
  std::string output;
};

Ran run(const std::vector<std::string>& words) {
  CLI::App program;
  Action action;
  add_encode_command(program, action);
  add_decode_command(program, action);
  add_info_command(program, action);
  add_page_command(program, action);
  try {
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError&) {
    return {2, ""};
  }
  testing::internal::CaptureStdout();
  const int code = action();
  return {code, testing::internal::GetCapturedStdout()};
}

class CodingCommandsTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ / name; }

 private:
  fs::path folder_ = fs::path(testing::TempDir()) / ("emap_" + std::to_string(::getpid()));
};

// A hill on a square.
Mesh hill() {
  constexpr std::uint32_t kSide = 50;
  Mesh mesh;
  for (std::uint32_t r = 0; r < kSide; ++r)
    for (std::uint32_t c = 0; c < kSide; ++c)
      mesh.positions.emplace_back(c, r, 8 * std::exp(-0.01 * (std::pow(c - 25.0, 2) + std::pow(r - 20.0, 2))));
  for (std::uint32_t r = 0; r + 1 < kSide; ++r)
    for (std::uint32_t c = 0; c + 1 < kSide; ++c) {
      const std::uint32_t a = r * kSide + c;
      mesh.triangles.push_back({a, a + 1, a + kSide});
      mesh.triangles.push_back({a + 1, a + kSide + 1, a + kSide});
    }
  return mesh;
}

TEST_F(CodingCommandsTest, AMeshGoesThereAndBack) {
  ASSERT_TRUE(write_ply(path("hill.ply"), hill()).ok());
  for (const std::string coder : {"contexts", "baseline"}) {
    const Ran encoded =
        run({"encode", path("hill.ply"), path("hill.emap"), "--psnr", "60", "--coder", coder, "--quiet"});
    ASSERT_EQ(encoded.code, 0);
    EXPECT_NE(encoded.output.find("bits per vertex"), std::string::npos);
    const auto info = nlohmann::json::parse(run({"info", path("hill.emap"), "--json"}).output);
    EXPECT_EQ(info["coder"], coder);
    EXPECT_FALSE(info["from_points"]);
    std::size_t bytes = 0;
    for (const auto& part : info["bytes"]) bytes += part.get<std::size_t>();
    EXPECT_EQ(bytes, fs::file_size(path("hill.emap")));
    ASSERT_EQ(run({"decode", path("hill.emap"), path("back.ply")}).code, 0);
    const auto comparison = compare_surfaces(*read_model(path("hill.ply")), *read_model(path("back.ply")));
    EXPECT_GT(comparison->psnr_db(), 59.5);
  }
}

TEST_F(CodingCommandsTest, PointsComeBackAsPointsUnlessAMeshIsAskedFor) {
  ASSERT_TRUE(write_ply(path("hill.ply"), hill()).ok());
  ASSERT_EQ(run({"encode", path("hill.ply"), path("hill.emap"), "--points", "--bpp", "4", "--quiet"}).code, 0);
  ASSERT_EQ(run({"decode", path("hill.emap"), path("points.ply")}).code, 0);
  EXPECT_FALSE(read_model(path("points.ply"))->is_mesh());
  ASSERT_EQ(run({"decode", path("hill.emap"), path("mesh.ply"), "--mesh"}).code, 0);
  EXPECT_TRUE(read_model(path("mesh.ply"))->is_mesh());
}

TEST_F(CodingCommandsTest, APageHoldsTheFileAndItsName) {
  ASSERT_TRUE(write_ply(path("hill.ply"), hill()).ok());
  ASSERT_EQ(run({"encode", path("hill.ply"), path("hill.emap"), "--psnr", "60", "--quiet"}).code, 0);
  const auto stream = thin::read_file_bytes(path("hill.emap"));
  for (const auto& [title, words] :
       {std::pair<std::string, std::vector<std::string>>("hill", {}), {"A hill", {"--title", "A hill"}}}) {
    std::vector<std::string> command = {"page", path("hill.emap"), path("hill.html")};
    command.insert(command.end(), words.begin(), words.end());
    ASSERT_EQ(run(command).code, 0);
    const auto page = thin::read_file_bytes(path("hill.html"));
    EXPECT_EQ(std::string(page->begin(), page->end()), web_page(title, *stream));
  }
  // What can't be decoded makes no page.
  ASSERT_TRUE(thin::write_file_bytes(path("cut.emap"), std::span(*stream).first(stream->size() / 2)).ok());
  EXPECT_EQ(run({"page", path("cut.emap"), path("cut.html")}).code, 3);
  EXPECT_FALSE(fs::exists(path("cut.html")));
}

TEST_F(CodingCommandsTest, WhatCannotBeIsSaid) {
  ASSERT_TRUE(write_ply(path("hill.ply"), hill()).ok());
  EXPECT_EQ(run({"encode", path("hill.ply"), path("x.emap"), "--bpp", "1", "--psnr", "60"}).code, 2);
  EXPECT_EQ(run({"encode", path("hill.ply"), path("x.emap"), "--coder", "none"}).code, 2);
  EXPECT_EQ(run({"encode", path("hill.ply"), path("x.emap"), "--bpp", "0.001", "--quiet"}).code, 2);
  EXPECT_EQ(run({"encode", path("absent.ply"), path("x.emap"), "--quiet"}).code, 3);
  EXPECT_EQ(run({"decode", path("hill.ply"), path("x.ply")}).code, 3);
  EXPECT_EQ(run({"info", path("hill.ply")}).code, 3);
  EXPECT_FALSE(fs::exists(path("x.emap")));
}

}  // namespace
}  // namespace emap
