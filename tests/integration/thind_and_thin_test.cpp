// thind with the real worker: BUFR in, BUFR out, whatever dies when.

#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <random>

#include "tests/support/netcdf_files.h"
#include "tests/support/shared_data.h"
#include "tests/support/thind_site.h"

namespace thin::test {
namespace {

// Six hours of two satellites in files of 20 minutes: made once for all tests.
const std::filesystem::path& synthetic_files() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const std::string output = (folder.path() / "files").string();
    Process synth({THIN_PROGRAM, "synth", "--output", output, "--satellite", "NOAA-15", "--satellite", "NOAA-16",
                   "--begin", "2004-07-21T21:00:00Z", "--duration-minutes", "360", "--minutes-per-file", "20"},
                  folder.path() / "log");
    return synth.wait() == 0;
  }();
  EXPECT_TRUE(made) << content_of(folder.path() / "log");
  static const std::filesystem::path files = folder.path() / "files";
  return files;
}

class ThindAndThinTest : public testing::Test {
 protected:
  ThindAndThinTest() : site_(THIN_PROGRAM) { set_up(site_); }
  static void set_up(Site& site) {
    site.rest = "[thinning]\nmethod = \"stepwise\"\n";
    site.daemon["retry_seconds"] = "0.1";
    site.daemon["max_interruptions"] = "1000";
    site.window["anchor_minutes"] = "-90";
  }
  static void deliver_all(const Site& site) {
    for (const auto& [name, content] : files_below(synthetic_files())) site.deliver(name, content);
  }
  static int file_count() { return static_cast<int>(files_below(synthetic_files()).size()); }
  bool there(const std::string& path) const { return std::filesystem::exists(site_.path(path)); }
  void TearDown() override {
    if (HasFailure()) std::printf("%s\n", site_.log().c_str());
  }
  Site site_;
};

// What comes out is BUFR that thin reads again, with fewer observations.
int observations_in(const std::filesystem::path& file) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "output";
  Process ingest({THIN_PROGRAM, "ingest", "--input", file.string(), "--output", (folder.path() / "staged.nc").string()},
                 output);
  EXPECT_EQ(ingest.wait(), 0) << content_of(output);
  const nlohmann::json said = nlohmann::json::parse(content_of(output), nullptr, false);
  return said.is_object() ? said.value("observations", -1) : -1;
}

TEST_F(ThindAndThinTest, AllFilesAtOnce) {
  deliver_all(site_);
  ASSERT_EQ(site_.run_once(), 0);
  EXPECT_EQ(site_.published(), file_count());
  EXPECT_TRUE(site_.consistent());
  EXPECT_EQ(files_below(site_.path("archive")), files_below(synthetic_files())) << "originals as they came";
  const nlohmann::json status = site_.status();
  ASSERT_EQ(status["windows"].size(), 3U);
  for (const nlohmann::json& window : status["windows"]) {
    EXPECT_EQ(window["state"], "published");
    int retained = 0;
    for (const auto& [name, content] : files_below(site_.path("outbox/" + window["output"].get<std::string>())))
      if (name != "report.json") {
        EXPECT_TRUE(content.starts_with("BUFR") && content.ends_with("7777")) << name;
        retained += observations_in(site_.path("outbox/" + window["output"].get<std::string>() + "/" + name));
      }
    EXPECT_EQ(retained, window["retained"]);
    EXPECT_LT(retained, window["observations"].get<int>() / 5);
  }
}

TEST_F(ThindAndThinTest, TheBytesDoNotDependOnOrderOrParallelism) {
  Site other(THIN_PROGRAM);
  set_up(other);
  site_.daemon["parallel_workers"] = "1";
  other.daemon["parallel_workers"] = "7";
  deliver_all(site_);
  ASSERT_EQ(site_.run_once(), 0);
  // One by one into a daemon that runs, last things first.
  other.window["cutoff_minutes"] = "99999999";
  Process daemon = other.start();
  const auto files = files_below(synthetic_files());
  for (auto file = files.rbegin(); file != files.rend(); ++file) other.deliver(file->first, file->second);
  ASSERT_TRUE(wait_until([&] { return other.in_state("staged") == file_count(); }));
  other.window.erase("cutoff_minutes");
  other.write_config();
  daemon.signal(SIGHUP);
  ASSERT_TRUE(wait_until([&] { return other.published() == file_count(); }));
  EXPECT_EQ(site_.outbox(), other.outbox());
}

TEST_F(ThindAndThinTest, KilledAtRandomAndStartedAgainItEndsWithTheSameBytes) {
  const unsigned seed = std::random_device()();
  std::printf("seed %u\n", seed);
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  Site calm(THIN_PROGRAM);
  set_up(calm);
  const auto fill = [](const Site& site) {
    deliver_all(site);
    site.deliver("not.bufr", "no soundings at all");
    site.deliver("again.bufr", files_below(synthetic_files()).begin()->second);
  };
  fill(calm);
  ASSERT_EQ(calm.run_once(), 3);
  fill(site_);
  int kills = 0, exit_code = 1000;
  while (exit_code >= 1000) {
    ASSERT_LT(kills, 300);
    Process daemon = site_.start({"--once"});
    const auto delay = std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 200 + 60 * kills)(random));
    if (!wait_until([&] { return daemon.has_ended(); }, delay)) ++kills, daemon.signal(SIGKILL);
    exit_code = daemon.wait();
    const nlohmann::json status = site_.status();
    if (status.contains("files")) {
      ASSERT_TRUE(status["files"]["balanced"].get<bool>() && status["missing"].empty()) << status;
    }
  }
  std::printf("killed %d times\n", kills);
  EXPECT_GT(kills, 5);
  EXPECT_EQ(site_.outbox(), calm.outbox());
  EXPECT_EQ(site_.published(), calm.published());
  EXPECT_EQ(site_.quarantined(), 1);
  EXPECT_EQ(site_.pending(), 0);
}

TEST_F(ThindAndThinTest, ATruncatedFileIsCompletedLater) {
  const auto files = files_below(synthetic_files());
  const auto& [name, content] = *files.begin();
  Process daemon = site_.start();
  ASSERT_TRUE(wait_until([&] { return site_.log_says("watches"); }));
  write_content(site_.path("inbox/" + name), content.substr(0, content.size() * 2 / 3));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("is incomplete") && there("inbox/" + name); }));
  EXPECT_EQ(site_.pending(), 1);
  std::ofstream(site_.path("inbox/" + name), std::ios::app | std::ios::binary)
      << content.substr(content.size() * 2 / 3);
  ASSERT_TRUE(wait_until([&] { return there("archive/" + name); }));
  EXPECT_EQ(content_of(site_.path("archive/" + name)), content);
  EXPECT_TRUE(wait_until([&] { return site_.published() == 1 && site_.consistent(); }));
}

TEST_F(ThindAndThinTest, PerFileModeKeepsNamesAndFormat) {
  site_.window["mode"] = "\"per_file\"";
  deliver_all(site_);
  ASSERT_EQ(site_.run_once(), 0);
  for (const auto& [name, content] : files_below(synthetic_files())) {
    EXPECT_TRUE(there("outbox/reports/" + name + ".json"));
    const std::string thinned = content_of(site_.path("outbox/" + name));
    EXPECT_TRUE(thinned.starts_with("BUFR"));
    EXPECT_LT(thinned.size(), content.size());
  }
}

struct LateCase {
  const char* late;
  const char* suffix;  // of the output with the late data; nullptr for none
  std::size_t files;   // in it
};

class LateTest : public ThindAndThinTest, public testing::WithParamInterface<LateCase> {};

TEST_P(LateTest, LateDataGoesWhereTheConfigurationSays) {
  const auto files = files_below(synthetic_files());
  std::vector<std::pair<std::string, std::string>> of_window;  // 22:30 to 01:30
  for (const auto& file : files)
    if (file.first.find("T2340") != std::string::npos || file.first.find("T0000") != std::string::npos)
      of_window.push_back(file);
  ASSERT_EQ(of_window.size(), 4U);
  site_.window["late"] = std::string("\"") + GetParam().late + "\"";
  Process daemon = site_.start();
  for (int i = 0; i < 3; ++i) site_.deliver(of_window[i].first, of_window[i].second);
  ASSERT_TRUE(wait_until([&] { return site_.published() == 3; }));
  const auto before = site_.outbox();
  site_.deliver(of_window[3].first, of_window[3].second);
  ASSERT_TRUE(wait_until([&] { return site_.published() == 4; }));
  const auto after = site_.outbox();
  for (const auto& [name, content] : before) EXPECT_EQ(after.at(name), content) << "what was published stays";
  if (!GetParam().suffix) {
    EXPECT_EQ(after, before);
    EXPECT_TRUE(wait_until([&] { return there("late/" + of_window[3].first); }));
    return;
  }
  const std::string output = std::string("20040721T223000Z-20040722T013000Z") + GetParam().suffix;
  EXPECT_EQ(files_below(site_.path("outbox/" + output)).size(), GetParam().files + 1);
}

INSTANTIATE_TEST_SUITE_P(Window, LateTest,
                         testing::Values(LateCase{"rethin", ".v2", 4}, LateCase{"separate", ".late1", 1},
                                         LateCase{"drop", nullptr, 0}),
                         [](const auto& tested) { return std::string(tested.param.late); });

TEST_F(ThindAndThinTest, RealFilesAndDamagedOnes) {
  THIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path observations = shared_data() / "observations";
  site_.window["mode"] = "\"per_file\"";
  site_.rest = "[thinning]\nmethod = \"stepwise\"\n[preparation]\n";
  int delivered = 0;
  for (const char* folder : {"amsua", "bad"})
    for (const auto& [name, content] : files_below(observations / folder)) {
      site_.deliver(std::filesystem::path(name).filename().string(), content);
      ++delivered;
    }
  const int exit_code = site_.run_once();
  EXPECT_TRUE(exit_code == 3 || exit_code == 75) << exit_code;
  EXPECT_TRUE(site_.consistent());
  const nlohmann::json files = site_.status()["files"];
  EXPECT_EQ(files["seen"].get<int>() + files["duplicates"].get<int>(), delivered);
  EXPECT_TRUE(there("outbox/AMSUA.bufr"));
  EXPECT_GE(files["quarantined"].get<int>(), 1);
  for (const auto& [name, content] : files_below(site_.path("quarantine")))
    if (name.ends_with(".reason.json")) {
      EXPECT_FALSE(nlohmann::json::parse(content)["reason"].get<std::string>().empty());
    }
}

// Files of netCDF's layouts, in one inbox with one that is cut and one that holds no soundings.
TEST_F(ThindAndThinTest, NetcdfGoesTheSameWay) {
  const TemporaryFolder made;
  const auto path = [&](const char* name) { return (made.path() / name).string(); };
  write_ioda(path("amsua_n19.nc4"), {.locations = 200});
  write_gsi(path("diag_amsua_n19_ges.nc4"), 200);
  write_feedback(path("fofRAD.nc"), {.reports = 200});
  write_foreign_cf(path("mhs.nc"), 200);
  site_.window["mode"] = "\"per_file\"";
  site_.rest =
      "[thinning]\nmethod = \"box\"\nhorizontal_mesh = 400\n[preparation]\nchannels = [\"amsua 1 2\", \"mhs 1 2\"]\n";
  Process daemon = site_.start();
  for (const char* name : {"amsua_n19.nc4", "diag_amsua_n19_ges.nc4", "fofRAD.nc", "mhs.nc"})
    site_.deliver(name, content_of(path(name)));
  write_ioda(path("empty.nc4"), {.locations = 3, .temperatures = false});
  site_.deliver("empty.nc4", content_of(path("empty.nc4")));
  ASSERT_TRUE(wait_until([&] { return site_.published() == 4 && site_.quarantined() == 1; }));
  for (const char* name : {"amsua_n19.nc4", "diag_amsua_n19_ges.nc4", "fofRAD.nc", "mhs.nc"}) {
    SCOPED_TRACE(name);
    const int all = observations_in(path(name)), retained = observations_in(site_.path(std::string("outbox/") + name));
    EXPECT_GT(retained, 0);
    EXPECT_LT(retained, all);
  }
  const std::string report = content_of(site_.path("outbox/reports/fofRAD.nc.json"));
  EXPECT_NE(report.find("innovations: obs - veri_data"), std::string::npos) << report;

  // One that is still on its way is given back, and taken when its end has come.
  write_ioda(path("late.nc4"), {.locations = 150});
  const std::string late = content_of(path("late.nc4"));
  write_content(site_.path("inbox/late.nc4"), late.substr(0, late.size() * 2 / 3));
  ASSERT_TRUE(wait_until([&] { return site_.log_says("late.nc4 is incomplete") && there("inbox/late.nc4"); }));
  std::ofstream(site_.path("inbox/late.nc4"), std::ios::app | std::ios::binary) << late.substr(late.size() * 2 / 3);
  EXPECT_TRUE(wait_until([&] { return site_.published() == 5 && site_.consistent(); }));
}

TEST_F(ThindAndThinTest, TheExampleConfigurationIsGood) {
  Process check({THIND_PROGRAM, "-c", PROJECT_FOLDER "/config/thind.toml", "--check"}, site_.path("log"));
  EXPECT_EQ(check.wait(), 0) << site_.log();
}

TEST_F(ThindAndThinTest, CheckNamesTheLinesOfAllSections) {
  site_.rest = "[thinning]\nmethod = \"stepwize\"\n";
  EXPECT_EQ(site_.start({"--check"}).wait(), 2);
  EXPECT_TRUE(site_.log_says("thind.toml:")) << site_.log();
  EXPECT_TRUE(site_.log_says("stepwize")) << site_.log();
}

}  // namespace
}  // namespace thin::test
