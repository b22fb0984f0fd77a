#include "libthin/tools/settings.h"

#include <gtest/gtest.h>

#include "libthin/tools/evaluation_settings.h"
#include "libthin/tools/twin_settings.h"

namespace thin {
namespace {

Result<Settings> settings_of(const std::string& text) {
  return read_settings(*Configuration::parse(text, "c.toml"));
}

std::string problem_of(const std::string& text) {
  const Result<Settings> settings = settings_of(text);
  if (settings) return "";
  EXPECT_EQ(settings.error().kind, ErrorKind::configuration);
  return settings.error().message;
}

TEST(Settings, TwoLinesAreEnough) {
  const Result<Settings> settings = settings_of("[thinning]\nmethod = \"grid_eea\"\nretain_fraction = 0.1\n");
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(settings->method_name, "grid_eea");
  EXPECT_EQ(settings->thinner->method_name(), "grid_eea");
  EXPECT_TRUE(settings_of("[thinning]\nmethod = \"stepwise\"\n"));
}

TEST(Settings, NameFileLineAndRemedy) {
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"grid_eae\"\n"),
            "c.toml:2:10: thinning.method = \"grid_eae\" is not a method; did you mean \"grid_eea\"?");
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"grid_eea\"\nretain_fractoin = 0.1\nretain_count = 3\n"),
            "c.toml:3:1: unknown key \"retain_fractoin\" in [thinning]; did you mean \"retain_fraction\"?");
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"stepwise\"\nstep = 3\nline_offset = 3\n"),
            "c.toml:4:15: thinning.line_offset must be less than step = 3, not 3");
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"stepwise\"\n[preperation]\n"),
            "c.toml:3:2: unknown section [preperation]; did you mean [preparation]?");
  EXPECT_NE(problem_of("[thinning]\nmethod = \"grid_eea\"\n").find("needs retain_count or retain_fraction"),
            std::string::npos);
  EXPECT_NE(problem_of("[thinning]\nretain_count = 3\nretain_fraction = 0.1\n").find("exclude each other"),
            std::string::npos);
}

TEST(Settings, AMethodsOptionsAreItsOwn) {
  EXPECT_NE(problem_of("[thinning]\nmethod = \"box\"\nretain_fraction = 0.1\n").find("unknown key \"retain_fraction\""),
            std::string::npos);
}

TEST(Settings, NameWhatIsWrongInThePreparation) {
  const std::string box = "[thinning]\nmethod = \"box\"\n[preparation]\n";
  EXPECT_EQ(
      problem_of(box + "duplicate_distnace_km = 3\n"),
      "c.toml:4:1: unknown key \"duplicate_distnace_km\" in [preparation]; did you mean \"duplicate_distance_km\"?");
  EXPECT_EQ(
      problem_of(box + "surface = [\"water\"]\n"),
      "c.toml:4:11: preparation.surface has the unknown surface \"water\"; known are sea, land, coast, ice, unknown");
  EXPECT_EQ(problem_of(box + "channels = [\"amsu 5\"]\n"),
            "c.toml:4:12: preparation.channels has the unknown instrument \"amsu\"; known are amsua, amsub, mhs, hirs, "
            "atms");
  EXPECT_EQ(problem_of(box + "first_guess = \"companion\"\n"),
            "c.toml:4:15: preparation.first_guess = \"companion\" needs companion_files: name the files that hold the "
            "first guess");
}

TEST(Settings, FlagsDoNotGoWithAMethodThatMakesObservations) {
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"superob\"\n"), "");
  EXPECT_NE(problem_of("[thinning]\nmethod = \"superob\"\n[output]\nmode = \"flag\"\n").find("CF netCDF alone"),
            std::string::npos);
}

TEST(Settings, LeaveTheDaemonsSectionsToIt) {
  EXPECT_EQ(problem_of("[thinning]\nmethod = \"box\"\n[daemon]\nanything = 1\n[window]\nelse = 2\n"), "");
}

// One file may tell all of the programs what they need.
TEST(Settings, LeaveTheSectionsOfOtherCommandsToThem) {
  const std::string text =
      "[thinning]\nretain_count = 9\n[daemon]\n[window]\n[input]\n[preparation]\n[output]\n[run]\n[evaluate]\n"
      "methods = [\"box\"]\n[synthetic]\nsource = \"spiral\"\n[twin]\n[cycle]\n";
  EXPECT_EQ(problem_of(text), "");
  EXPECT_TRUE(read_evaluation_settings(*Configuration::parse(text, "c.toml")));
  EXPECT_TRUE(read_twin_settings(*Configuration::parse(text, "c.toml")));
}

TEST(Settings, NothingResolvedDependsOnTheThreads) {
  const auto one = settings_of("[thinning]\nmethod = \"box\"\n[run]\nthreads = 1\n");
  const auto two = settings_of("[thinning]\nmethod = \"box\"\n[run]\nthreads = 2\n");
  EXPECT_EQ(one->threads, 1);
  EXPECT_EQ(one->resolved, two->resolved);
}

}  // namespace
}  // namespace thin
