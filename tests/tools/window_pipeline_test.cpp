#include "libthin/tools/window_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "libthin/foundation/parallel.h"
#include "libthin/tools/report.h"
#include "tests/support/extraction_checks.h"
#include "tests/support/shared_data.h"
#include "tests/support/synthetic_files.h"

namespace thin {
namespace {

using test::kSyntheticBeginMs;
using test::read_bytes;
using test::ScratchFolder;

Settings settings_of(const std::string& text) {
  Result<Settings> settings = read_settings(*Configuration::parse(text, "c.toml"));
  EXPECT_TRUE(settings) << settings.error().message;
  return std::move(*settings);
}

const char* const kTenth = "[thinning]\nmethod = \"grid_eea\"\nretain_fraction = 0.1\n";

std::vector<WindowFile> read_all(const std::vector<std::string>& paths) {
  std::vector<WindowFile> files;
  for (const std::string& path : paths) {
    Result<ReadObservations> contents = read_observations(path);
    EXPECT_TRUE(contents) << contents.error().message;
    files.push_back({std::filesystem::path(path).filename(), path, std::move(*contents)});
  }
  return files;
}

std::string folder(const ScratchFolder& scratch, const std::string& name) {
  std::filesystem::create_directories(scratch.path(name));
  return scratch.path(name);
}

// Name and bytes of everything in a folder.
std::map<std::string, test::ByteVector> contents_of(const std::string& path) {
  std::map<std::string, test::ByteVector> contents;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    contents[entry.path().filename()] = read_bytes(entry.path());
  return contents;
}

TEST(WindowPipeline, BytesDependOnNeitherOrderNorThreads) {
  const ScratchFolder scratch;
  const std::vector<std::string> paths = {
      test::write_synthetic_file(scratch.path("b"), "NOAA-15", kSyntheticBeginMs, 40),
      test::write_synthetic_file(scratch.path("a"), "NOAA-15", kSyntheticBeginMs + 320'000, 40),
      test::write_synthetic_file(scratch.path("c"), "NOAA-16", kSyntheticBeginMs, 60)};
  const Settings settings = settings_of(kTenth);
  const auto thinned = [&](const std::string& name, std::vector<std::string> order, int threads) {
    const ThreadLimit limit(threads);
    const auto outcome = thin_window(read_all(order), {}, {}, settings, folder(scratch, name));
    EXPECT_TRUE(outcome) << outcome.error().message;
    return contents_of(scratch.path(name));
  };
  const auto expected = thinned("one", paths, 1);
  EXPECT_EQ(expected.size(), 4U);
  EXPECT_EQ(thinned("two", {paths[2], paths[0], paths[1]}, 2), expected);
}

TEST(WindowPipeline, RetainsTheShareAndCountsEverything) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "Metop-A", kSyntheticBeginMs, 60);
  const auto outcome = thin_window(read_all({path}), {}, {}, settings_of(kTenth), folder(scratch, "out"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->prepared.observations.size(), 1800U);
  EXPECT_EQ(outcome->retained.size(), 180U);
  ASSERT_EQ(outcome->files.size(), 1U);
  EXPECT_EQ(outcome->files[0].output.subsets, 180U);
  const EstimationError& error = outcome->errors.at(Instrument::amsua).whole;
  EXPECT_GT(error.mean_squared_k2, 0);
  EXPECT_LT(error.mean_squared_k2, error.empty_mean_squared_k2);
  const auto read_back = read_observations(scratch.path("out/a"));
  ASSERT_TRUE(read_back);
  EXPECT_EQ(read_back->observations.size(), 180U);
}

// What a method makes goes out as CF; of the inputs themselves there is no output.
TEST(WindowPipeline, WritesTheMeansOfSuperobbingAsCf) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "NOAA-15", kSyntheticBeginMs, 60);
  const Settings settings = settings_of("[thinning]\nmethod = \"superob\"\nhorizontal_mesh = 300\n");
  const auto outcome = thin_window(read_all({path}), {}, {}, settings, folder(scratch, "out"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto contents = contents_of(scratch.path("out"));
  EXPECT_EQ(contents.size(), 2U);
  EXPECT_TRUE(contents.contains("superobs-amsua.nc"));

  const auto means = read_observations(scratch.path("out/superobs-amsua.nc"));
  ASSERT_TRUE(means) << means.error().message;
  ASSERT_EQ(means->observations.size(), outcome->members.size());
  const auto original = read_observations(path);
  ASSERT_TRUE(original);
  std::size_t members = 0;
  for (std::size_t i = 0; i < outcome->members.size(); ++i) {
    double sum = 0;
    for (const std::uint32_t p : outcome->members[i])
      sum += original->observations.values_of(outcome->prepared.origin[p])[5];
    members += outcome->members[i].size();
    EXPECT_NEAR(means->observations.values_of(i)[5], sum / static_cast<double>(outcome->members[i].size()), 1e-4);
  }
  EXPECT_EQ(members, 1800U);
  const EstimationError& error = outcome->errors.at(Instrument::amsua).whole;
  EXPECT_GT(error.mean_squared_k2, 0);
  EXPECT_LT(error.mean_squared_k2, 0.5 * error.empty_mean_squared_k2);
}

// Two windows side by side: every observation that one keeps is in its own time, and nothing is in both.
TEST(WindowPipeline, AFileAcrossTwoWindowsIsSharedBetweenThem) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 60);
  const std::int64_t cut_ms = kSyntheticBeginMs + 30 * 8000;
  const Settings settings = settings_of("[thinning]\nmethod = \"grid_eea\"\nretain_fraction = 1\n");
  std::size_t total = 0;
  for (const TimeWindow& window : {TimeWindow{{}, cut_ms}, TimeWindow{cut_ms, {}}}) {
    const std::string out = folder(scratch, window.begin_ms ? "late" : "early");
    ASSERT_TRUE(thin_window(read_all({path}), {}, window, settings, out));
    const auto kept = read_observations(out + "/a");
    ASSERT_TRUE(kept);
    for (const std::int64_t time_ms : kept->observations.time_ms) EXPECT_TRUE(window.holds(time_ms));
    total += kept->observations.size();
  }
  EXPECT_EQ(total, 1800U);
}

TEST(WindowPipeline, RefusesAWindowWithNothingInIt) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 2);
  const auto outcome = thin_window(read_all({path}), {}, {0, 1000}, settings_of(kTenth), folder(scratch, "out"));
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().kind, ErrorKind::input);
  EXPECT_NE(outcome.error().message.find("of 60 observations 60 lie outside the window"), std::string::npos)
      << outcome.error().message;
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path("out")));
}

TEST(WindowPipeline, AFileOfWhichNothingIsRetainedLeavesNoOutput) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 20);
  const auto outcome =
      thin_window(read_all({path}), {}, {}, settings_of("[thinning]\nmethod = \"grid_eea\"\nretain_count = 0\n"),
                  folder(scratch, "out"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(contents_of(scratch.path("out")).size(), 1U);  // the report
}

// The same granule under two names, and one of them again a little beside: one of each is left, and the report says so.
TEST(WindowPipeline, DuplicatesGoBeforeThinning) {
  const ScratchFolder scratch;
  const auto once = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 40);
  const auto again = test::write_synthetic_file(scratch.path("b"), "NOAA-16", kSyntheticBeginMs, 40);
  const auto beside = test::write_synthetic_file(scratch.path("rars"), "NOAA-16", kSyntheticBeginMs + 400, 20);
  const Settings settings = settings_of(
      "[thinning]\nmethod = \"grid_eea\"\nretain_fraction = 1\n[preparation]\nduplicate_file_order = [\"b\", "
      "\"r*\"]\n");
  const auto outcome = thin_window(read_all({once, again, beside}), {}, {}, settings, folder(scratch, "out"));
  ASSERT_TRUE(outcome) << outcome.error().message;
  const SounderTally& tally = outcome->prepared.sounders.at({207, Instrument::amsua});
  EXPECT_EQ(tally.observations, 3000U);
  EXPECT_EQ(tally.exact_duplicates, 1200U);
  EXPECT_EQ(tally.near_duplicates, 600U);
  EXPECT_EQ(outcome->retained.size(), 1200U);
  EXPECT_EQ(contents_of(scratch.path("out")).size(), 2U) << "b and the report";
  const test::ByteVector bytes = read_bytes(scratch.path("out/report.json"));
  const std::string report(bytes.begin(), bytes.end());
  EXPECT_NE(report.find("\"exact\": 1200"), std::string::npos) << report;
}

// AMSU-A twice, one of them called MHS: each is prepared, thinned and judged by itself, as if it were alone.
TEST(WindowPipeline, InstrumentsAreThinnedApart) {
  const ScratchFolder scratch;
  const auto first = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 40);
  const auto second = test::write_synthetic_file(scratch.path("b"), "NOAA-16", kSyntheticBeginMs, 30);
  std::vector<WindowFile> files = read_all({first, second});
  files[1].contents.observations.instrument.assign(900, Instrument::mhs);
  const Settings settings = settings_of(std::string(kTenth) + "[preparation]\nchannels = [\"mhs 3-5\"]\n");
  const auto both = thin_window(files, {}, {}, settings, folder(scratch, "both"));
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->retained.size(), 210U);
  EXPECT_EQ(both->errors.size(), 2U);
  EXPECT_EQ(both->errors.at(Instrument::mhs).whole.per_channel_k2.size(), 3U);
  EXPECT_EQ(both->retained_by_sounder.at({207, Instrument::mhs}), 90U);
  const auto alone = thin_window({files[1]}, {}, {}, settings, folder(scratch, "alone"));
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_EQ(read_bytes(scratch.path("both/b")), read_bytes(scratch.path("alone/b")));
  EXPECT_NE(report_table(*both).find("all MHS"), std::string::npos) << report_table(*both);
}

TEST(WindowPipeline, SaysWhyNothingIsLeft) {
  const ScratchFolder scratch;
  const auto path = test::write_synthetic_file(scratch.path("a"), "NOAA-16", kSyntheticBeginMs, 2);
  const auto outcome =
      thin_window(read_all({path}), {}, {},
                  settings_of(std::string(kTenth) + "[preparation]\nplatforms = [\"Aqua\"]\n"), folder(scratch, "out"));
  ASSERT_FALSE(outcome);
  EXPECT_NE(outcome.error().message.find("60 were screened out (60 satellite not among platforms)"), std::string::npos)
      << outcome.error().message;
}

// A file with model equivalents as its own companion: the same innovations, so the same choice.
TEST(WindowPipeline, ACompanionGivesWhatTheFileItselfWould) {
  THIN_REQUIRE_SHARED_DATA();
  const ScratchFolder scratch;
  const std::string path = test::shared_data() / "observations/ioda/amsua_n19.20211211T210000Z.nc4";
  const std::string common =
      std::string(kTenth) + "[input]\nplatform = \"NOAA-19\"\n[preparation]\nchannels = [5, 6]\n";
  const auto thinned = [&](const std::string& name, const std::string& more) {
    const Settings settings = settings_of(common + more);
    Result<ReadObservations> contents = read_observations(path, settings.input);
    EXPECT_TRUE(contents) << contents.error().message;
    auto outcome = thin_window({{"a.nc4", path, std::move(*contents)}}, {}, {}, settings, folder(scratch, name));
    EXPECT_TRUE(outcome) << outcome.error().message;
    return std::move(*outcome);
  };
  const WindowOutcome own = thinned("own", "first_guess = \"file\"\n");
  const WindowOutcome other = thinned("other", "first_guess = \"companion\"\ncompanion_files = [\"" + path + "\"]\n");
  EXPECT_GT(own.prepared.first_guess.given, 1000U);
  EXPECT_EQ(own.prepared.first_guess.given, other.prepared.first_guess.given);
  EXPECT_EQ(own.prepared.observations.values, other.prepared.observations.values);
  EXPECT_EQ(own.retained, other.retained);
}

// Every real file: the output decodes with ecCodes alone, holds exactly the retained fields of view, and every key of
// every retained subset equals the original.
TEST(WindowPipeline, RealFilesKeepEveryKeyOfEveryRetainedSubset) {
  THIN_REQUIRE_SHARED_DATA();
  const ScratchFolder scratch;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::shared_data() / "observations/amsua")) {
    const std::string name = entry.path().filename();
    SCOPED_TRACE(name);
    ++files;
    const std::string out = folder(scratch, "out-" + name);
    const auto outcome = thin_window(read_all({entry.path()}), {}, {}, settings_of(kTenth), out);
    ASSERT_TRUE(outcome) << outcome.error().message;

    std::map<std::uint32_t, std::set<std::uint32_t>> retained;  // by message
    for (const std::uint32_t i : outcome->retained) {
      const SourceReference& source = outcome->prepared.observations.source[i];
      retained[source.message].insert(source.subset);
    }
    const auto originals = test::decode_file_slowly(entry.path());
    const auto thinned = test::decode_file_slowly(out + "/" + name);
    ASSERT_EQ(thinned.size(), retained.size());
    std::size_t place = 0;
    for (const auto& [message, subsets] : retained)
      test::expect_kept(originals[message], {subsets.begin(), subsets.end()}, thinned[place++]);
  }
  EXPECT_GE(files, 6U);
}

}  // namespace
}  // namespace thin
