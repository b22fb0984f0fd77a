// NCEP's tanks: synthetic ones beside what was written and beside ecCodes, which is handed the definitions that it
// lacks; the real one beside ecCodes. A program of its own: ecCodes takes definitions once, for the whole process.

#include <eccodes.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "libthin/formats/bufr_file.h"
#include "libthin/formats/observation_file.h"
#include "tests/support/extraction_checks.h"
#include "tests/support/shared_data.h"
#include "tests/support/soundings_equal.h"
#include "tests/support/tank_writer.h"

namespace thin {
namespace {

using test::ByteVector;
using test::ScratchFolder;
using test::tank_soundings;
using test::TankShape;
using test::TankSounding;

const TankShape kAmsuA;
const TankShape kMhs = {.instrument = 203, .channels = 5, .sequence = 361234};

// Definitions for ecCodes alone: libthin finds no local tables by a message that names none.
class EccodesDefinitions : public testing::Environment {
 public:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("thin.tank_definitions." + std::to_string(::getpid()));
    const auto tables = folder_ / "bufr/tables/0/local/0/7/3";
    std::filesystem::create_directories(tables);
    test::write_bytes(tables / "element.table", test::bytes_of(test::eccodes_elements()));
    test::write_bytes(tables / "sequence.def", test::bytes_of(test::eccodes_sequences({kAmsuA, kMhs})));
    codes_context* context = codes_context_get_default();
    const std::string path = folder_.string() + ":" + codes_definition_path(context);
    codes_context_set_definitions_path(context, path.c_str());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

 private:
  std::filesystem::path folder_;
};
[[maybe_unused]] const auto* const kDefinitions = testing::AddGlobalTestEnvironment(new EccodesDefinitions);

ByteVector tank(const TankShape& shape, int count = 40) {
  const auto soundings = tank_soundings(count, shape);
  return test::joined({tank_table_message(tank_tables(shape)), ByteVector(8, 0), tank_data_message(soundings, shape),
                       ByteVector(4, 0), tank_data_message(soundings, shape), ByteVector(2, 0)});
}

// `begin`: of the first message's soundings in the set.
void expect_as_written(const ObservationSet& set, std::size_t begin, const TankShape& shape, int count = 40) {
  const auto soundings = tank_soundings(count, shape);
  const double unit_k = shape.temperature_scale == 3 ? 0.001 : 0.01;
  for (std::size_t i = 0; i < soundings.size(); ++i) {
    const TankSounding& sounding = soundings[i];
    const std::size_t at = begin + i;
    EXPECT_NEAR(set.latitude_deg[at], static_cast<double>(sounding.latitude_e4) / 10'000, 1e-9);
    EXPECT_NEAR(set.longitude_deg[at], static_cast<double>(sounding.longitude_e4) / 10'000, 1e-9);
    EXPECT_EQ(set.time_ms[at], *to_time_ms({2020, 10, 26, 21, 3, static_cast<double>(sounding.second)}));
    EXPECT_EQ(set.platform[at], 3);
    EXPECT_EQ(set.scan_line[at], kUnknownNumber);
    EXPECT_EQ(set.field_of_view[at], sounding.field_of_view);
    EXPECT_EQ(set.surface[at], sounding.surface == 0   ? Surface::land
                               : sounding.surface == 1 ? Surface::sea
                                                       : Surface::coast);
    EXPECT_EQ(set.variables.at("surface_height_m")[at], sounding.height_m);
    EXPECT_NEAR(set.variables.at("satellite_zenith_angle_deg")[at], static_cast<double>(sounding.zenith_e2) / 100,
                1e-9);
    for (std::size_t channel = 0; channel < sounding.temperature.size(); ++channel) {
      const double value_k = set.values_of(at)[channel];
      if (sounding.temperature[channel] < 0)
        EXPECT_TRUE(std::isnan(value_k));
      else
        EXPECT_NEAR(value_k, static_cast<double>(sounding.temperature[channel]) * unit_k, 1e-9);
    }
  }
}

ObservationSet read(const ByteVector& file) {
  const auto contents = read_bufr(file, "tank");
  EXPECT_TRUE(contents.ok()) << contents.error().message;
  return contents ? contents->observations : ObservationSet{};
}

class Tanks : public testing::TestWithParam<TankShape> {};

TEST_P(Tanks, ReadAsWritten) {
  const auto contents = read_bufr(tank(GetParam()), "tank");
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->message_count, 3U);
  EXPECT_TRUE(contents->skipped.empty());
  EXPECT_EQ(contents->notes, std::vector<std::string>{"decoded with the tables that it brings, in 1 message"});
  ASSERT_EQ(contents->observations.size(), 80U);
  ASSERT_EQ(contents->observations.channel_count(), static_cast<std::size_t>(GetParam().channels));
  expect_as_written(contents->observations, 0, GetParam());
  expect_as_written(contents->observations, 40, GetParam());
  EXPECT_EQ(contents->observations.source[40], (SourceReference{0, 2, 0}));
}

TEST_P(Tanks, AnExtractionBringsItsTables) {
  const ScratchFolder folder;
  const std::string path = folder.write("tank", tank(GetParam()));
  const auto before = read_observations(path);
  ASSERT_TRUE(before.ok());
  std::vector<SourceReference> retained;
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 3; i < 80; i += 7) {
    retained.push_back(before->observations.source[i]);
    places.push_back(i);
  }
  const auto summary =
      extract_observations(path, retained, folder.path("out"), {.other_messages = OutputOptions::OtherMessages::drop});
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  EXPECT_EQ(summary->messages, 3U);
  const auto after = read_observations(folder.path("out"));
  ASSERT_TRUE(after.ok()) << after.error().message;
  const ObservationSet expected = before->observations.select(places);
  ASSERT_EQ(after->observations.size(), expected.size());
  EXPECT_EQ(after->observations.latitude_deg, expected.latitude_deg);
  EXPECT_EQ(after->observations.time_ms, expected.time_ms);
  EXPECT_EQ(after->observations.surface, expected.surface);
  for (std::size_t i = 0; i < expected.values.size(); ++i)
    EXPECT_TRUE(test::same_number(after->observations.values[i], expected.values[i]));
}

INSTANTIATE_TEST_SUITE_P(Bufr, Tanks,
                         testing::Values(kAmsuA, kMhs, TankShape{.compressed = false},
                                         TankShape{.counted_channels = true},
                                         TankShape{.compressed = false, .counted_channels = true},
                                         TankShape{.temperature_width = 19, .temperature_scale = 3}));

TEST(BufrTank, EqualsEcCodesWithTheDefinitionsThatItLacks) {
  for (const TankShape& shape : {kAmsuA, kMhs}) {
    const ScratchFolder folder;
    const std::string path = folder.write("tank", tank(shape));
    const auto contents = read_observations(path);
    ASSERT_TRUE(contents.ok()) << contents.error().message;
    test::expect_equal_to_keys(contents->observations, path);
    std::vector<SourceReference> half;
    for (std::size_t i = 0; i < contents->observations.size(); i += 2) half.push_back(contents->observations.source[i]);
    test::expect_extraction_keeps_values(path, half);
  }
}

// The same descriptors, other meanings: tables reach no other file, nor the messages in front of them.
TEST(BufrTank, TablesReachNoOtherFile) {
  const TankShape one, other = {.temperature_width = 19, .temperature_scale = 3};
  for (int round = 0; round < 2; ++round) {
    expect_as_written(read(tank(one)), 0, one);
    expect_as_written(read(tank(other)), 0, other);
  }
  const ObservationSet both = read(test::joined({tank(one), tank(other), tank(one)}));
  ASSERT_EQ(both.size(), 240U);
  expect_as_written(both, 40, one);
  expect_as_written(both, 80, other);
  expect_as_written(both, 200, one);
}

TEST(BufrTank, TablesInSeveralMessages) {
  test::TankTables elements = tank_tables(kAmsuA), sequences = elements;
  elements.sequences.clear();
  sequences.elements.clear();
  const ObservationSet set = read(test::joined({tank_table_message(elements), tank_table_message(sequences),
                                                test::tank_message(11, 1, 0, false, {103000, 31001, 1, 2, 3}, {}),
                                                tank_data_message(tank_soundings(40, kAmsuA), kAmsuA)}));
  ASSERT_EQ(set.size(), 40U);
  expect_as_written(set, 0, kAmsuA);
}

TEST(BufrTank, WithoutItsTablesItIsRefusedWithTheRemedy) {
  const ByteVector data = tank_data_message(tank_soundings(4, kAmsuA), kAmsuA);
  const auto contents = read_bufr(data, "tank");
  ASSERT_FALSE(contents.ok());
  EXPECT_NE(contents.error().message.find("whose tables are not in the file"), std::string::npos);
  EXPECT_NE(contents.error().message.find("Send the tank as a whole"), std::string::npos);

  test::TankTables without_sequence = tank_tables(kAmsuA);
  without_sequence.sequences.erase(without_sequence.sequences.begin());
  const auto lacking = read_bufr(test::joined({tank_table_message(without_sequence), data}), "tank");
  ASSERT_FALSE(lacking.ok());
}

TEST(BufrTank, ItsOwnTablesSufficeWhereEcCodesLacksWmos) {
  for (const bool counted : {false, true}) {
    const TankShape shape = {.counted_channels = counted};
    ByteVector data = tank_data_message(tank_soundings(40, shape), shape);
    data[8 + 10] = 200;  // version of WMO's tables
    const ObservationSet set = read(test::joined({tank_table_message(tank_tables(shape)), data}));
    ASSERT_EQ(set.size(), 40U);
    expect_as_written(set, 0, shape);
  }
}

// Of three tanks in one file the first is left out as a whole, and tables that can't be read stay where they were: what
// is in force for the data that are left stays the same.
TEST(BufrTank, ExtractionsKeepTablesAndDataTogether) {
  const TankShape one, other = {.temperature_width = 19, .temperature_scale = 3};
  ByteVector damaged = tank_table_message(tank_tables(one));
  damaged[8 + 18 + 7 + 30 + 1 + 4 + 1] = 0xff;  // entries of table B
  const ByteVector lost = tank_data_message(tank_soundings(40, one), one);
  const ByteVector file = test::joined({tank(one), tank(other), damaged, lost});
  const ScratchFolder folder;
  const auto before = read_observations(folder.write("tank", file));
  ASSERT_TRUE(before.ok()) << before.error().message;
  ASSERT_EQ(before->observations.size(), 160U);
  EXPECT_EQ(before->skipped.size(), 2U);

  std::vector<SourceReference> retained;
  for (std::size_t i = 80; i < 160; i += 2) retained.push_back(before->observations.source[i]);
  const auto summary = extract_observations(folder.path("tank"), retained, folder.path("out"), {});
  ASSERT_TRUE(summary.ok()) << summary.error().message;
  const auto after = read_observations(folder.path("out"));
  ASSERT_TRUE(after.ok()) << after.error().message;
  ASSERT_EQ(after->observations.size(), 40U);
  for (std::size_t i = 0; i < 40; ++i)
    for (std::size_t channel = 0; channel < 15; ++channel)
      EXPECT_TRUE(test::same_number(after->observations.values_of(i)[channel],
                                    before->observations.values_of(80 + 2 * i)[channel]));
}

TEST(BufrTank, TablesAloneAreNotWritten) {
  const ScratchFolder folder;
  const auto summary = extract_observations(folder.write("tank", tank(kMhs)), {}, folder.path("out"), {});
  ASSERT_TRUE(summary.ok());
  EXPECT_EQ(summary->messages, 0U);
  EXPECT_FALSE(std::filesystem::exists(folder.path("out")));
}

// Numbers that no integer holds, and scales that leave no number: found by the search of tests/fuzz.
TEST(BufrTank, SenselessScalesAreNoSoundings) {
  const ByteVector data = tank_data_message(tank_soundings(4, kAmsuA), kAmsuA);
  for (const int scale : {-12, -300, 300}) {
    test::TankTables tables = tank_tables(kAmsuA);
    tables.elements[0].scale = scale;  // the year's
    const auto contents = read_bufr(test::joined({tank_table_message(tables), data}), "tank");
    ASSERT_FALSE(contents.ok());
    EXPECT_EQ(contents.error().kind, ErrorKind::input);
  }
}

// Sequences that hold themselves, or one another many times over.
TEST(BufrTank, TablesWithoutEndAreRefused) {
  test::TankTables endless = tank_tables(kAmsuA);
  endless.sequences.front().members.push_back(361171);
  test::TankTables doubling = tank_tables(kAmsuA);
  for (int i = 0; i < 60; ++i) doubling.sequences.push_back({362001 + i, "DOUBLE", {362002 + i, 362002 + i}});
  doubling.sequences.push_back({362061, "NOTHING", {202000}});
  doubling.sequences.front().members.push_back(362001);
  const ByteVector data = tank_data_message(tank_soundings(4, kAmsuA), kAmsuA);
  for (const test::TankTables& tables : {endless, doubling}) {
    const auto contents = read_bufr(test::joined({tank_table_message(tables), data}), "tank");
    ASSERT_FALSE(contents.ok());
    EXPECT_EQ(contents.error().kind, ErrorKind::input);
  }
}

TEST(RealTank, Equals1bmhsInEcCodes) {
  THIN_REQUIRE_SHARED_DATA();
  const std::string path = (test::shared_data() / "observations/ncep/gdas.t00z.1bmhs.tm00.bufr_d").string();
  const auto contents = read_observations(path);
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  ASSERT_EQ(contents->observations.size(), 22336U);
  EXPECT_EQ(contents->instrument, "MHS");
  EXPECT_EQ(contents->message_count, 52U);
  test::expect_equal_to_keys(contents->observations, path);
  std::vector<SourceReference> tenth;
  for (std::size_t i = 0; i < contents->observations.size(); i += 10) tenth.push_back(contents->observations.source[i]);
  test::expect_extraction_keeps_values(path, tenth);
}

}  // namespace
}  // namespace thin
