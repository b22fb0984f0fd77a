// The whole way on AMSU-A from four satellites in one window, from one configuration file: thind gathers the global
// data and what direct readout brought of it again, takes each field of view once, screens by surface and scan
// position, and thins the satellites together.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/thind_site.h"

namespace thin::test {
namespace {

using Files = std::map<std::string, std::string>;

const char* const kConfiguration = R"(
[thinning]
method = "grid_eea"
retain_fraction = 0.1

[preparation]
channels = ["amsua 5-10"]
duplicate_file_order = ["amsua_*", "rars_*"]
skip_edge_positions = 2
surface = ["sea", "coast"]
)";

Files synthesise(const std::vector<std::string>& satellites, const std::string& begin, int minutes) {
  const TemporaryFolder folder;
  std::vector<std::string> words = {THIN_PROGRAM,
                                    "synth",
                                    "--output",
                                    (folder.path() / "files").string(),
                                    "--begin",
                                    begin,
                                    "--duration-minutes",
                                    std::to_string(minutes),
                                    "--minutes-per-file",
                                    "20"};
  for (const std::string& satellite : satellites) words.insert(words.end(), {"--satellite", satellite});
  Process synth(words, folder.path() / "log");
  EXPECT_EQ(synth.wait(), 0) << content_of(folder.path() / "log");
  return files_below(folder.path() / "files");
}

const Files& global_data() {
  static const Files files = synthesise({"NOAA-15", "NOAA-16", "NOAA-18", "Metop-A"}, "2006-11-21T23:00:00Z", 40);
  return files;
}

class FourSatellitesTest : public testing::Test {
 protected:
  FourSatellitesTest() {
    if (!std::filesystem::exists("/usr/share/gmt-gshhg/binned_GSHHS_l.nc")) lacks_shorelines_ = true;
  }
  static void set_up(Site& site) {
    site.rest = kConfiguration;
    site.window["anchor_minutes"] = "-90";
  }
  static nlohmann::json only_report(const Site& site) {
    for (const auto& [name, content] : site.outbox())
      if (name.ends_with("report.json")) return nlohmann::json::parse(content);
    return {};
  }
  static Files outputs(const Site& site) {
    Files files = site.outbox();
    std::erase_if(files, [](const auto& file) { return file.first.ends_with("report.json"); });
    return files;
  }
  bool lacks_shorelines_ = false;
};

TEST_F(FourSatellitesTest, DuplicatesLeaveNoTraceButTheirCount) {
  if (lacks_shorelines_) GTEST_SKIP() << "no GSHHG shorelines: install gmt-gshhg-low";
  Site clean(THIN_PROGRAM), crowded(THIN_PROGRAM);
  set_up(clean);
  set_up(crowded);
  for (const auto& [name, content] : global_data()) {
    clean.deliver(name, content);
    crowded.deliver(name, content);
  }
  // Readout a second beside the global data, then exactly at its scan lines, then all messages of a file twice.
  const Files beside = synthesise({"NOAA-15"}, "2006-11-21T23:08:01Z", 10);
  const Files at_it = synthesise({"Metop-A"}, "2006-11-21T23:16:00Z", 10);
  for (const auto& [name, content] : beside) crowded.deliver("rars_a_" + name, content);
  for (const auto& [name, content] : at_it) crowded.deliver("rars_b_" + name, content);
  const std::string& metop = global_data().at("amsua_metopa_20061121T230000Z.bufr");
  crowded.deliver("rars_c.bufr", metop + metop);
  ASSERT_EQ(clean.run_once(), 0) << clean.log();
  ASSERT_EQ(crowded.run_once(), 0) << crowded.log();
  EXPECT_TRUE(crowded.consistent());

  const nlohmann::json report = only_report(crowded), clean_report = only_report(clean);
  ASSERT_EQ(report["satellites"].size(), 4U) << crowded.log();
  std::map<std::string, int> duplicates;
  int total = 0, accounted = 0;
  for (const nlohmann::json& satellite : report["satellites"]) {
    EXPECT_EQ(satellite["instrument"], "AMSU-A");
    int twice = 0, screened = 0;
    for (const auto& [kind, count] : satellite["duplicates"].items()) twice += count.get<int>();
    for (const auto& [reason, count] : satellite["screened"].items()) screened += count.get<int>();
    duplicates[satellite["name"]] = twice;
    total += satellite["observations"].get<int>();
    accounted += twice + screened + satellite["prepared"].get<int>();
    EXPECT_GT(satellite["screened"]["scan position at the edge"], 0);
    EXPECT_GT(satellite["retained"], 0);
  }
  EXPECT_EQ(total, accounted);
  EXPECT_EQ(duplicates["NOAA-15"], 75 * 30) << "ten minutes of it";
  EXPECT_EQ(duplicates["Metop-A"], 75 * 30 + 2 * 150 * 30);
  EXPECT_EQ(duplicates["NOAA-16"], 0);
  EXPECT_EQ(report["observations"]["duplicates"], 2 * 75 * 30 + 2 * 150 * 30);

  // The global data is kept, so all that comes out is what came out without them.
  EXPECT_EQ(report["observations"]["prepared"], clean_report["observations"]["prepared"]);
  EXPECT_TRUE(outputs(crowded) == outputs(clean));
  EXPECT_EQ(clean_report["observations"]["duplicates"], 0);
}

TEST_F(FourSatellitesTest, ThinRunDoesTheSame) {
  if (lacks_shorelines_) GTEST_SKIP() << "no GSHHG shorelines: install gmt-gshhg-low";
  Site site(THIN_PROGRAM);
  set_up(site);
  const TemporaryFolder folder;
  std::vector<std::string> words = {THIN_PROGRAM,
                                    "run",
                                    "--explain",
                                    "-c",
                                    site.path("thind.toml").string(),
                                    "-o",
                                    (folder.path() / "out").string(),
                                    "--begin",
                                    "2006-11-21T22:30:00Z",
                                    "--end",
                                    "2006-11-22T01:30:00Z"};
  std::filesystem::create_directories(folder.path() / "in");
  for (const auto& [name, content] : global_data()) {
    site.deliver(name, content);
    write_content(folder.path() / "in" / name, content);
    words.push_back((folder.path() / "in" / name).string());
  }
  ASSERT_EQ(site.run_once(), 0) << site.log();
  Process run(words, folder.path() / "log");
  EXPECT_EQ(run.wait(), 0) << content_of(folder.path() / "log");
  EXPECT_NE(content_of(folder.path() / "log").find("4 screening"), std::string::npos);
  Files published;
  for (const auto& [name, content] : site.outbox()) published[std::filesystem::path(name).filename()] = content;
  EXPECT_EQ(files_below(folder.path() / "out"), published);
}

TEST_F(FourSatellitesTest, TheExampleOfATOVSIsGood) {
  for (const char* name : {"atovs.toml", "reprocess.toml"}) {
    Site site(THIN_PROGRAM);
    Process check({THIND_PROGRAM, "-c", std::string(PROJECT_FOLDER "/config/") + name, "--check"}, site.path("log"));
    EXPECT_EQ(check.wait(), 0) << site.log();
  }
}

}  // namespace
}  // namespace thin::test
