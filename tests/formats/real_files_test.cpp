// Files from weather centres, read in place. Without them these tests are skipped.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include "libthin/formats/bufr_scanner.h"
#include "libthin/formats/observation_file.h"
#include "libthin/observations/time.h"
#include "tests/support/bufr_oracle.h"
#include "tests/support/extraction_checks.h"
#include "tests/support/netcdf_oracle.h"
#include "tests/support/shared_data.h"
#include "tests/support/soundings_equal.h"

namespace thin {
namespace {

std::string real_file(const std::string& name) {
  return (test::shared_data() / "observations" / name).string();
}

struct SounderFile {
  const char* name;
  Instrument instrument;
  std::size_t observations;
  std::uint32_t messages;
  int platform;
  std::size_t lines;
  int last_field_of_view;
  std::vector<int> missing_channels;
};

constexpr const char* kHirsOrbit =
    "sounders/M02-HIRS-HIRxxx1B-NA-1.0-20181122114854.000000000Z-20181122132602-1304602.bufr";

// As the index of the files says.
const SounderFile kSounderFiles[] = {
    {"amsua/AMSUA.bufr", Instrument::amsua, 1350, 1, 4, 45, 30, {7}},
    {"amsua/amsa_55.bufr", Instrument::amsua, 660, 6, 4, 22, 30, {7}},
    {"amsua/aaen_55.bufr", Instrument::amsua, 420, 4, 209, 14, 30, {}},
    {"amsua/amsu_55.bufr", Instrument::amsua, 277, 3, 784, 10, 30, {4}},
    {"amsua/atov_55.bufr", Instrument::amsua, 30, 1, 207, 1, 30, {4}},
    {"amsua/amsu-a-noaa-19.bufr", Instrument::amsua, 30, 1, 223, 1, 30, {1, 2}},
    {"sounders/hirs_55.bufr", Instrument::hirs, 1064, 9, 4, 19, 56, {}},
    {"sounders/mhsa_55.bufr", Instrument::mhs, 1170, 10, 4, 13, 90, {}},
    {"sounders/metop_mhs.bufr", Instrument::mhs, 6030, 4, 4, 67, 90, {}},
    {"sounders/atms_201.bufr", Instrument::atms, 189, 2, 224, 2, 96, {}},
    {kHirsOrbit, Instrument::hirs, 51968, 61, 4, 928, 56, {}},
};

std::string test_name(const testing::TestParamInfo<SounderFile>& info) {
  std::string name = std::filesystem::path(info.param.name).stem().string().substr(0, 24);
  std::erase_if(name, [](char letter) { return !std::isalnum(static_cast<unsigned char>(letter)); });
  return name;
}

class RealSounder : public testing::TestWithParam<SounderFile> {
 protected:
  void SetUp() override { THIN_REQUIRE_SHARED_DATA(); }
};

TEST_P(RealSounder, HoldsWhatTheIndexSays) {
  const SounderFile& file = GetParam();
  const Result<ReadObservations> contents = read_observations(real_file(file.name));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const ObservationSet& set = contents->observations;
  ASSERT_EQ(set.size(), file.observations);
  EXPECT_EQ(contents->message_count, file.messages);
  EXPECT_EQ(contents->instrument, instrument_name(file.instrument));
  std::set<int> lines;
  std::vector<std::size_t> present(set.channel_count(), 0);
  for (std::size_t i = 0; i < set.size(); ++i) {
    ASSERT_EQ(set.platform[i], file.platform);
    ASSERT_TRUE(set.field_of_view[i] >= 1 && set.field_of_view[i] <= file.last_field_of_view) << set.field_of_view[i];
    lines.insert(set.scan_line[i]);
    for (std::size_t place = 0; place < set.channel_count(); ++place) {
      const double value_k = set.values_of(i)[place];
      ASSERT_TRUE(std::isnan(value_k) || (value_k > 90 && value_k < 350)) << value_k;
      present[place] += std::isnan(value_k) ? 0 : 1;
    }
  }
  EXPECT_EQ(lines.size(), file.lines);
  for (std::size_t place = 0; place < present.size(); ++place)
    EXPECT_EQ(present[place] == 0,
              std::count(file.missing_channels.begin(), file.missing_channels.end(), set.channels[place]) > 0)
        << set.channels[place];
}

TEST_P(RealSounder, EqualsTheOracle) {
  const std::string path = real_file(GetParam().name);
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  test::expect_equal_to_keys(contents->observations, path);
}

TEST_P(RealSounder, ExtractionsKeepEveryKeyOfEveryRetainedSubset) {
  const std::string path = real_file(GetParam().name);
  if (GetParam().observations <= 1500) return test::expect_extractions_keep_everything(path, 7);
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  std::vector<SourceReference> tenth;
  for (std::size_t i = 0; i < contents->observations.size(); i += 10) tenth.push_back(contents->observations.source[i]);
  test::expect_extraction_keeps_values(path, tenth);
}

// Nothing is left out: what comes out is what went in, but for bytes that belong to no message.
TEST_P(RealSounder, RetainingAllKeepsEveryByteOfEveryMessage) {
  const std::string path = real_file(GetParam().name);
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const test::ScratchFolder folder;
  ASSERT_TRUE(extract_observations(path, contents->observations.source, folder.path("out"), {}).ok());
  const test::ByteVector original = test::read_bytes(path), written = test::read_bytes(folder.path("out"));
  const BufrScan before = scan_bufr(original), after = scan_bufr(written);
  ASSERT_EQ(before.messages.size(), after.messages.size());
  for (std::size_t i = 0; i < before.messages.size(); ++i) {
    const auto message_of = [&](const test::ByteVector& bytes, const BufrScan& scan) {
      return std::span(bytes).subspan(scan.messages[i].offset, scan.messages[i].length);
    };
    const auto ours = message_of(written, after), theirs = message_of(original, before);
    EXPECT_TRUE(std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end())) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, RealSounder, testing::ValuesIn(kSounderFiles), test_name);

TEST(RealAtms, HasAntennaTemperaturesToo) {
  THIN_REQUIRE_SHARED_DATA();
  const std::string path = real_file("sounders/atms_201.bufr");
  InputOptions options;
  options.bufr_temperature = BufrTemperature::antenna;
  const auto contents = read_observations(path, options);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  test::expect_equal_to_keys(contents->observations, path, "antennaTemperature");
}

TEST(RealTimes, AreThoseOfTheScanNotOfTheHeader) {
  THIN_REQUIRE_SHARED_DATA();
  const Result<ReadObservations> contents = read_observations(real_file("amsua/AMSUA.bufr"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const auto [first, last] =
      std::minmax_element(contents->observations.time_ms.begin(), contents->observations.time_ms.end());
  EXPECT_EQ(to_iso8601(*first).substr(0, 19), "2013-05-29T12:23:43");
  EXPECT_EQ(to_iso8601(*last).substr(0, 19), "2013-05-29T12:29:35");
}

struct IodaFile {
  const char* name;
  std::size_t observations, channels;
  int platform;
  const char* rule;
  bool unlimited;
};

// Counts as ncdump says them.
const IodaFile kIodaFiles[] = {
    {"ioda/amsua_n19.20211211T210000Z.nc4", 9238, 15, kUnknownNumber,
     "innovations: ObsValue - GsiHofXBc where GsiEffectiveQC is 0", true},
    {"ioda/ioda_obs_space.amsua_n19.hofx.2020-12-14T210000Z.nc4", 100, 15, 223,
     "innovations: ObsValue - GsiHofXBc where EffectiveQC is 0", false},
    {"ioda/test-ATOVS.hdf", 200, 20, 3, "values: ObsValue", false},
};

class RealIoda : public testing::TestWithParam<IodaFile> {
 protected:
  void SetUp() override { THIN_REQUIRE_SHARED_DATA(); }
};

TEST_P(RealIoda, HoldsWhatNcdumpSays) {
  const std::string path = real_file(GetParam().name);
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const ObservationSet& set = contents->observations;
  EXPECT_EQ(contents->layout, "ioda");
  EXPECT_EQ(set.size(), GetParam().observations);
  EXPECT_EQ(set.channel_count(), GetParam().channels);
  EXPECT_EQ(set.platform[0], GetParam().platform);
  ASSERT_FALSE(contents->notes.empty());
  EXPECT_EQ(contents->notes.front(), GetParam().rule);
  // Every innovation is the difference of the two groups as netCDF-C gives them, where quality control accepts.
  const auto variables = test::read_all_variables(path);
  const auto number = [&](const char* group, std::size_t place) {
    float value = 0;
    std::memcpy(&value, variables.at(std::string(group) + "/brightnessTemperature").values[place].data(), sizeof value);
    return static_cast<double>(value);
  };
  const bool gsi = variables.contains("GsiEffectiveQC/brightnessTemperature");
  const bool has_first_guess = variables.contains("GsiHofXBc/brightnessTemperature");
  for (std::size_t i = 0; i < set.values.size(); ++i) {
    if (has_first_guess) {
      const auto& flags =
          variables.at(gsi ? "GsiEffectiveQC/brightnessTemperature" : "EffectiveQC/brightnessTemperature");
      std::int32_t flag = 0;
      std::memcpy(&flag, flags.values[i].data(), sizeof flag);
      ASSERT_EQ(std::isnan(set.values[i]), flag != 0) << i;
    }
    if (std::isnan(set.values[i])) continue;
    ASSERT_EQ(set.values[i], number("ObsValue", i));
    if (!has_first_guess) continue;
    ASSERT_EQ(set.first_guess_k[i], number("GsiHofXBc", i));
  }
}

TEST_P(RealIoda, OutputsKeepEverythingOfTheRetained) {
  const std::string path = real_file(GetParam().name);
  const Result<ReadObservations> contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const test::ScratchFolder folder;
  for (const test::Selection& selection : test::selections_of(contents->observations.source, 11)) {
    SCOPED_TRACE(selection.name);
    const auto summary = extract_observations(path, selection.retained, folder.path("out.nc4"), {});
    ASSERT_TRUE(summary.ok()) << summary.error().message;
    ASSERT_TRUE(extract_observations(path, selection.retained, folder.path("again.nc4"), {}).ok());
    EXPECT_TRUE(test::read_bytes(folder.path("again.nc4")) == test::read_bytes(folder.path("out.nc4")));
    std::vector<std::size_t> locations;
    for (const SourceReference& source : selection.retained) locations.push_back(source.subset);
    test::expect_retained(path, folder.path("out.nc4"), {{"Location", locations}});
    const bool chunks = GetParam().unlimited || selection.name == "all";
    // netCDF refuses to compress texts, and chunks texts alone where they were compressed.
    const auto without_texts = [](std::multiset<std::string> lines) {
      std::erase_if(lines, [](const std::string& line) { return line.find("variable_names:_") != std::string::npos; });
      return lines;
    };
    EXPECT_EQ(without_texts(test::header_lines(folder.path("out.nc4"), chunks)),
              without_texts(test::header_lines(path, chunks)));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, RealIoda, testing::ValuesIn(kIodaFiles));

struct RefusedFile {
  const char* name;
  const char* said;  // what the error must name
};

const RefusedFile kRefusedFiles[] = {
    {"sounders/iasi_241.bufr", "IASI radiances or principal components"},
    {"sounders/smis_49.bufr", "SSMIS"},
    {"ncep/1bamua.bufr.subset.txt", "no BUFR message"},
    {"other/prepbufr.bufr", "prepBUFR"},
    {"other/Z__C_EDZW_20210516120400_bda01,synop_bufr_GER_999999_999999__MW_466.bufr", "44 x SYNOP"},
    {"other/synop_multi_subset.bufr", "SYNOP"},
    {"other/temp_101.bufr", "TEMP"},
    {"other/airc_142.bufr", "AIREP"},
    {"ioda/satwind.20211211T210000Z.nc4", "without soundings in a layout that is read here"},
    {"bad/corruptBUFR.1", "no 7777"},
    {"bad/isaa41_cytr_broken.bufr", "section 4 runs over"},
    {"bad/isaa41_cyvv_broken.bufr", "section 3 runs over"},
    {"bad/segfault1.bufr", "TEMP"},
    {"bad/unparsable1.bufr", "AIREP"},
};

class RealRefused : public testing::TestWithParam<RefusedFile> {};

TEST_P(RealRefused, NamesWhatItIs) {
  THIN_REQUIRE_SHARED_DATA();
  const Result<ReadObservations> contents = read_observations(real_file(GetParam().name));
  ASSERT_FALSE(contents.ok());
  EXPECT_EQ(contents.error().kind, ErrorKind::input);
  EXPECT_NE(contents.error().message.find(GetParam().said), std::string::npos) << contents.error().message;
  EXPECT_NE(contents.error().message.find(GetParam().name), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Files, RealRefused, testing::ValuesIn(kRefusedFiles));

}  // namespace
}  // namespace thin
