// Messages of every shape, read through read_observations and beside the oracle.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "libthin/formats/observation_file.h"
#include "libthin/observations/time.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/bufr_oracle.h"
#include "tests/support/soundings_equal.h"

namespace thin {
namespace {

using test::ByteVector;
using test::kMissingValue;
using test::make_message;
using test::MessageShape;
using test::ScratchFolder;
using test::test_soundings;
using test::TestSounding;

MessageShape shape_of(bool compressed, int edition = 4) {
  return {.edition = edition, .compressed = compressed};
}

ReadObservations read_bytes_as_file(const ByteVector& bytes) {
  const ScratchFolder folder;
  const std::string path = folder.write("file.bufr", bytes);
  Result<ReadObservations> contents = read_observations(path);
  EXPECT_TRUE(contents.ok()) << contents.error().message;
  if (!contents) return {};
  if (contents->skipped.empty()) test::expect_equal_to_oracle(contents->observations, test::decode_file_slowly(path));
  return std::move(*contents);
}

ReadObservations read_soundings(const std::vector<TestSounding>& soundings, const MessageShape& shape = {}) {
  return read_bytes_as_file(make_message(soundings, shape));
}

Error error_of(const ByteVector& bytes) {
  const ScratchFolder folder;
  const Result<ReadObservations> contents = read_observations(folder.write("file.bufr", bytes));
  EXPECT_FALSE(contents.ok());
  return contents ? Error{} : contents.error();
}

class Shapes : public testing::TestWithParam<MessageShape> {};

TEST_P(Shapes, ReadAsWritten) {
  const std::vector<TestSounding> soundings = test_soundings(45);
  const ReadObservations contents = read_soundings(soundings, GetParam());
  const ObservationSet& set = contents.observations;
  ASSERT_EQ(set.size(), 45U);
  EXPECT_EQ(contents.layout, "bufr");
  EXPECT_EQ(contents.instrument, "AMSU-A");
  EXPECT_EQ(contents.message_count, 1U);
  EXPECT_TRUE(contents.skipped.empty());
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_NEAR(set.latitude_deg[i], soundings[i].latitude_deg, 1e-4);
    EXPECT_NEAR(set.longitude_deg[i], soundings[i].longitude_deg, 1e-4);
    EXPECT_EQ(set.time_ms[i], *to_time_ms({2020, 6, 15, 12, 30, soundings[i].second}));
    EXPECT_EQ(set.platform[i], 4);
    EXPECT_EQ(set.scan_line[i], soundings[i].scan_line);
    EXPECT_EQ(set.field_of_view[i], soundings[i].field_of_view);
    EXPECT_EQ(set.surface[i], Surface::unknown);
    EXPECT_EQ(set.source[i], (SourceReference{0, 0, static_cast<std::uint32_t>(i)}));
    for (std::size_t channel = 0; channel < 15; ++channel)
      EXPECT_NEAR(set.values_of(i)[channel], soundings[i].slots[channel].second, 0.0051);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bufr, Shapes,
    testing::Values(MessageShape{}, shape_of(false), shape_of(true, 3), shape_of(false, 3),
                    MessageShape{.descriptors = {310008}, .slots_per_subset = 19},
                    MessageShape{.compressed = false, .descriptors = {310008}, .slots_per_subset = 19},
                    MessageShape{.descriptors = {310009, 33007, 12063}, .temperatures_behind = 1},
                    MessageShape{.compressed = false, .descriptors = {310009, 33007, 12063}, .temperatures_behind = 1},
                    MessageShape{.descriptors = {1031, 310009}}, MessageShape{.ecmwf_section2 = true}));

TEST(BufrSoundings, OneSubsetOfEitherKind) {
  for (const bool compressed : {false, true})
    EXPECT_EQ(read_soundings(test_soundings(1), shape_of(compressed)).observations.size(), 1U);
}

TEST(BufrSoundings, ChannelsStandInAnySlotAndDifferBetweenSubsets) {
  std::vector<TestSounding> soundings = test_soundings(20);
  std::mt19937 random(5);
  for (TestSounding& sounding : soundings) std::shuffle(sounding.slots.begin(), sounding.slots.end(), random);
  for (const bool compressed : {false, true}) {
    const ReadObservations contents = read_soundings(soundings, shape_of(compressed));
    ASSERT_EQ(contents.observations.size(), 20U);
    for (std::size_t i = 0; i < 20; ++i)
      for (const auto& [code, temperature] : soundings[i].slots)
        EXPECT_NEAR(contents.observations.values_of(i)[static_cast<std::size_t>(code - 28)], temperature, 0.0051);
  }
}

TEST(BufrSoundings, UnusedSlotsAndDeadChannelsAreMissing) {
  std::vector<TestSounding> soundings = test_soundings(4);
  for (TestSounding& sounding : soundings) {
    sounding.slots[2] = {0, 0};                          // unused, as some centres write it
    sounding.slots[3] = {kMissingValue, kMissingValue};  // unused, as others do
    sounding.slots[6].second = kMissingValue;            // dead
    sounding.slots[9] = {47, 250};                       // another instrument's
  }
  soundings[1].slots[0].second = kMissingValue;
  for (const bool compressed : {false, true}) {
    const ObservationSet set = read_soundings(soundings, shape_of(compressed)).observations;
    ASSERT_EQ(set.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t channel = 0; channel < 15; ++channel) {
        const bool missing = channel == 2 || channel == 3 || channel == 6 || channel == 9 || (i == 1 && channel == 0);
        EXPECT_EQ(std::isnan(set.values_of(i)[channel]), missing) << i << " " << channel;
      }
  }
}

TEST(BufrSoundings, OfTwoSlotsTheFirstWithATemperatureCounts) {
  std::vector<TestSounding> soundings = test_soundings(2);
  soundings[0].slots[1] = {28, 300};
  soundings[1].slots[0].second = kMissingValue;
  soundings[1].slots[1] = {28, 300};
  const ObservationSet set = read_soundings(soundings).observations;
  EXPECT_NEAR(set.values_of(0)[0], 201, 0.0051);
  EXPECT_NEAR(set.values_of(1)[0], 300, 0.0051);
}

TEST(BufrSoundings, TimeTurnsTheYearWithinAMessage) {
  std::vector<TestSounding> soundings = test_soundings(4);
  const double clocks[4][6] = {
      {2019, 12, 31, 23, 59, 59.75}, {2019, 12, 31, 23, 59, 60}, {2020, 1, 1, 0, 0, 0.125}, {2020, 2, 29, 6, 7, 8.999}};
  for (std::size_t i = 0; i < 4; ++i) {
    soundings[i].year = clocks[i][0];
    soundings[i].month = clocks[i][1];
    soundings[i].day = clocks[i][2];
    soundings[i].hour = clocks[i][3];
    soundings[i].minute = clocks[i][4];
    soundings[i].second = clocks[i][5];
  }
  for (const bool compressed : {false, true}) {
    const ObservationSet set = read_soundings(soundings, shape_of(compressed)).observations;
    ASSERT_EQ(set.size(), 4U);
    EXPECT_EQ(to_iso8601(set.time_ms[0]), "2019-12-31T23:59:59.750Z");
    EXPECT_EQ(to_iso8601(set.time_ms[1]), "2020-01-01T00:00:00Z");
    EXPECT_EQ(to_iso8601(set.time_ms[2]), "2020-01-01T00:00:00.125Z");
    EXPECT_EQ(to_iso8601(set.time_ms[3]), "2020-02-29T06:07:08.999Z");
  }
}

TEST(BufrSoundings, PositionsAtTheEdgesOfTheMap) {
  std::vector<TestSounding> soundings = test_soundings(5);
  const double places[5][2] = {{90, 0}, {-90, 0}, {0, 180}, {0, -180}, {12.3456, -179.9999}};
  for (std::size_t i = 0; i < 5; ++i) {
    soundings[i].latitude_deg = places[i][0];
    soundings[i].longitude_deg = places[i][1];
  }
  const ObservationSet set = read_soundings(soundings).observations;
  ASSERT_EQ(set.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(set.latitude_deg[i], places[i][0]);
    EXPECT_DOUBLE_EQ(set.longitude_deg[i], places[i][1]);
    EXPECT_TRUE(std::abs(set.latitude_deg[i]) <= 90 && set.longitude_deg[i] >= -180);
  }
}

TEST(BufrSoundings, SubsetsWithoutPositionOrTimeAreLeftOutAndCounted) {
  std::vector<TestSounding> soundings = test_soundings(8);
  soundings[1].latitude_deg = kMissingValue;
  soundings[2].longitude_deg = kMissingValue;
  soundings[3].hour = kMissingValue;
  soundings[4].month = 13;
  soundings[5].latitude_deg = 95;
  soundings[6].second = kMissingValue;
  for (const bool compressed : {false, true}) {
    const ReadObservations contents = read_soundings(soundings, shape_of(compressed));
    ASSERT_EQ(contents.observations.size(), 2U);
    EXPECT_EQ(contents.observations.source[1].subset, 7U);
    ASSERT_EQ(contents.skipped.size(), 1U);
    EXPECT_NE(contents.skipped[0].reason.find("6 subsets"), std::string::npos) << contents.skipped[0].reason;
  }
}

TEST(BufrSoundings, NumbersThatAreMissingAreUnknown) {
  std::vector<TestSounding> soundings = test_soundings(3);
  for (TestSounding& s : soundings) s.platform = s.scan_line = s.field_of_view = kMissingValue;
  const ObservationSet set = read_soundings(soundings).observations;
  ASSERT_EQ(set.size(), 3U);
  EXPECT_EQ(set.platform[2], kUnknownNumber);
  EXPECT_EQ(set.scan_line[2], kUnknownNumber);
  EXPECT_EQ(set.field_of_view[2], kUnknownNumber);
}

TEST(BufrSoundings, WithoutSensorTheChannelsDecide) {
  std::vector<TestSounding> soundings = test_soundings(3);
  for (TestSounding& s : soundings) s.sensor = kMissingValue;
  EXPECT_EQ(read_soundings(soundings).observations.size(), 3U);
  for (TestSounding& s : soundings) s.slots[14].first = 43;
  EXPECT_EQ(error_of(make_message(soundings)).kind, ErrorKind::input);
}

TEST(BufrSoundings, OtherSensorsAreNamed) {
  std::vector<TestSounding> soundings = test_soundings(3);
  for (const auto& [sensor, name] :
       {std::pair(1, "MSU (sensor 1)"), std::pair(5, "AVHRR"), std::pair(9, "another instrument (sensor 9)")}) {
    for (TestSounding& s : soundings) s.sensor = sensor;
    const Error error = error_of(make_message(soundings, {.descriptors = {310008}, .slots_per_subset = 19}));
    EXPECT_EQ(error.kind, ErrorKind::input);
    EXPECT_NE(error.message.find(name), std::string::npos) << error.message;
  }
}

TEST(BufrSoundings, SubsetsOfAnotherSensorAreLeftOut) {
  std::vector<TestSounding> soundings = test_soundings(6);
  soundings[2].sensor = soundings[3].sensor = 5;
  const ReadObservations contents = read_soundings(soundings);
  EXPECT_EQ(contents.observations.size(), 4U);
  EXPECT_EQ(contents.skipped.size(), 1U);
}

TEST(BufrSoundings, MessagesCountOnOverEnvelopesStrayBytesAndOtherKinds) {
  std::vector<TestSounding> other = test_soundings(3);
  for (TestSounding& s : other) s.sensor = 5;
  const ByteVector amsua = make_message(test_soundings(5)), avhrr = make_message(other);
  ByteVector damaged = amsua;
  damaged.back() = 'x';
  const ReadObservations contents = read_bytes_as_file(test::joined(
      {test::bulletin(amsua), test::bytes_of("junk"), avhrr, {0, 0}, damaged, amsua, test::bytes_of("0000000000")}));
  EXPECT_EQ(contents.message_count, 3U);
  ASSERT_EQ(contents.observations.size(), 10U);
  EXPECT_EQ(contents.observations.source[0], (SourceReference{0, 0, 0}));
  EXPECT_EQ(contents.observations.source[5], (SourceReference{0, 2, 0}));
  ASSERT_EQ(contents.skipped.size(), 3U);
  EXPECT_NE(contents.skipped[0].reason.find("4 stray bytes"), std::string::npos);
  EXPECT_EQ(contents.skipped[1].message, 1U);
  EXPECT_NE(contents.skipped[1].reason.find("AVHRR"), std::string::npos);
  EXPECT_NE(contents.skipped[2].reason.find("7777"), std::string::npos);
}

TEST(BufrSoundings, DescriptorsThatShiftRanksAreRefused) {
  const ByteVector two_latitudes = make_message(test_soundings(2), {.descriptors = {5001, 310009}});
  EXPECT_NE(error_of(two_latitudes).message.find("5001"), std::string::npos);
}

TEST(BufrSoundings, TablesAndReplicationsThatAreNotThereAreRefused) {
  const ByteVector message = make_message(test_soundings(2), {.descriptors = {310009, 101002, 33007}});
  EXPECT_EQ(read_bytes_as_file(message).observations.size(), 2U);
  ByteVector unknown_tables = message, long_replication = message;
  unknown_tables[8 + 13] = 200;
  EXPECT_NE(error_of(unknown_tables).message.find("version 200 of master table 0"), std::string::npos);
  const std::size_t replication = 8 + 22 + 7 + 2;
  ASSERT_EQ(message[replication], 0x41);
  for (const int replicated : {0, 2, 31}) {
    long_replication[replication] = static_cast<std::uint8_t>(0x40 + replicated);
    EXPECT_NE(error_of(long_replication).message.find("repeat more descriptors"), std::string::npos) << replicated;
  }
}

TEST(BufrSoundings, OperatorsThatAreNotReadAreNamed) {
  const ByteVector message = make_message(test_soundings(2), {.descriptors = {310009, 33007, 33007, 33007}});
  const auto with = [&](int x, int y) {
    ByteVector changed = message;
    changed[8 + 22 + 9] = static_cast<std::uint8_t>(0x80 + x);
    changed[8 + 22 + 10] = static_cast<std::uint8_t>(y);
    return error_of(changed).message;
  };
  EXPECT_NE(with(31, 31).find("operator 231031, which is not read"), std::string::npos);  // none of table C
  EXPECT_NE(with(24, 255).find("operator 224255, which is not read"), std::string::npos);
  EXPECT_NE(with(1, 100).find("leave no bits to element 033007"), std::string::npos) << with(1, 100);
}

// A few bytes must not grow to millions of observations.
TEST(BufrSoundings, MoreSubsetsThanBitsAreRefused) {
  ByteVector message = make_message(test_soundings(1));
  message[8 + 22 + 4] = 0xff;  // 65,281 subsets, all of them the same
  EXPECT_NE(error_of(message).message.find("more subsets than bits"), std::string::npos) << error_of(message).message;
}

struct Sounder {
  Instrument instrument;
  int sensor, first_code, channels;
  MessageShape shape;
};

class Sounders : public testing::TestWithParam<Sounder> {
 protected:
  std::vector<TestSounding> soundings(int count) const {
    std::vector<TestSounding> made = test_soundings(count);
    for (TestSounding& sounding : made) {
      sounding.sensor = GetParam().sensor;
      sounding.slots.clear();
      for (int channel = 1; channel <= GetParam().channels; ++channel)
        sounding.slots.emplace_back(GetParam().first_code + channel - 1, 200 + channel + 0.1 * sounding.field_of_view);
    }
    return made;
  }
};

TEST_P(Sounders, ReadAsWritten) {
  for (const bool compressed : {false, true}) {
    MessageShape shape = GetParam().shape;
    shape.compressed = compressed;
    const ReadObservations contents = read_soundings(soundings(7), shape);
    EXPECT_EQ(contents.instrument, instrument_name(GetParam().instrument));
    const ObservationSet& set = contents.observations;
    ASSERT_EQ(set.size(), 7U);
    ASSERT_EQ(set.channel_count(), static_cast<std::size_t>(GetParam().channels));
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(set.instrument[i], GetParam().instrument);
      for (std::size_t place = 0; place < set.channel_count(); ++place)
        EXPECT_NEAR(set.values_of(i)[place], 201.1 + static_cast<double>(place) + 0.1 * static_cast<double>(i), 0.0051);
    }
  }
}

TEST_P(Sounders, AFileOfTwoInstrumentsIsOneSet) {
  const ByteVector file = test::joined({make_message(soundings(3), GetParam().shape), make_message(test_soundings(2)),
                                        make_message(soundings(1), GetParam().shape)});
  const ScratchFolder folder;
  const auto contents = read_observations(folder.write("file", file));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const ObservationSet& set = contents->observations;
  ASSERT_EQ(set.size(), 6U);
  EXPECT_TRUE(contents->skipped.empty());
  if (GetParam().instrument == Instrument::amsua) return;
  EXPECT_EQ(contents->instrument, "AMSU-A, " + std::string(instrument_name(GetParam().instrument)));
  EXPECT_EQ(set.channel_count(), 15 + static_cast<std::size_t>(GetParam().channels));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(set.source[i].message == 1, set.instrument[i] == Instrument::amsua);
    for (std::size_t place = 0; place < set.channel_count(); ++place)
      EXPECT_EQ(std::isnan(set.values_of(i)[place]), !set.measures(i, place));
  }
}

// HIRS and AMSU-A in one message, as the sensor of each subset says.
TEST_P(Sounders, SubsetsOfTwoInstrumentsInOneMessage) {
  std::vector<TestSounding> both = soundings(4);
  both[1].sensor = 3;
  both[1].slots = {{28, 250}};
  const ScratchFolder folder;
  const auto contents = read_observations(folder.write("file", make_message(both, GetParam().shape)));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  const ObservationSet& set = contents->observations;
  ASSERT_EQ(set.size(), 4U);
  const auto amsua = std::find(set.instrument.begin(), set.instrument.end(), Instrument::amsua);
  ASSERT_NE(amsua, set.instrument.end());
  EXPECT_EQ(set.source[static_cast<std::size_t>(amsua - set.instrument.begin())].subset,
            GetParam().instrument == Instrument::amsua ? 0U : 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Bufr, Sounders,
    testing::Values(Sounder{Instrument::amsua, 3, 28, 15, {}},
                    Sounder{Instrument::amsub, 4, 43, 5, {.descriptors = {310010}, .slots_per_subset = 5}},
                    Sounder{Instrument::mhs, 11, 43, 5, {.descriptors = {310010}, .slots_per_subset = 5}},
                    Sounder{
                        Instrument::mhs, 11, 43, 5, {.edition = 3, .descriptors = {310008}, .slots_per_subset = 19}},
                    Sounder{Instrument::hirs, 0, 1, 19, {.descriptors = {310008}, .slots_per_subset = 19}}),
    [](const auto& test) {
      const bool long_form = test.param.shape.descriptors.front() == 310008;
      std::string name = instrument_name(test.param.instrument) + std::string(long_form ? "In310008" : "");
      std::erase(name, '-');
      return name;
    });

}  // namespace
}  // namespace thin
