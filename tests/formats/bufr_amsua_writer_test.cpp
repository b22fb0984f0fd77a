#include "libthin/formats/bufr_amsua_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"
#include "libthin/observations/time.h"
#include "tests/support/bufr_oracle.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kNoaa16 = 207;

class BufrAmsuaWriter : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "thin-writer-XXXXXX").string();
    ASSERT_TRUE(::mkdtemp(pattern.data()));
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path() const { return (folder_ / "soundings.bufr").string(); }

  static std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

// Every field anywhere in its range; over midnight and the change of an orbit; some values missing, channel 4 all of
// it.
std::vector<AmsuaSounding> random_soundings(int lines, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  const std::int64_t begin_ms = from_iso8601("2004-12-31T23:59:30.250Z").value();
  std::vector<AmsuaSounding> soundings;
  for (int line = 0; line < lines; ++line)
    for (int f = 1; f <= kAmsuaFieldsOfView; ++f) {
      AmsuaSounding s;
      s.view = {begin_ms + line * kAmsuaLineMs + f * kAmsuaStepMs,
                uniform(-90, 90),
                uniform(-180, 180),
                uniform(700, 900),
                uniform(0, 60),
                uniform(0, 360),
                uniform(0, 180),
                uniform(0, 360)};
      s.scan_line = 700 + line;
      s.field_of_view = f;
      s.orbit_number = line < lines / 2 ? 99'999 : 100'000;
      for (double& value : s.brightness_temperature_k) value = uniform(0, 20) < 1 ? kMissing : uniform(100, 350);
      s.brightness_temperature_k[3] = kMissing;
      soundings.push_back(s);
    }
  return soundings;
}

void expect_number(const test::OracleMessage& message, const std::string& key, std::size_t subset, double expected,
                   double step) {
  const double found = test::oracle_number(message, key, subset);
  if (std::isnan(expected))
    EXPECT_TRUE(std::isnan(found)) << key;
  else
    EXPECT_NEAR(found, expected, step / 2 + 1e-9) << key << " of subset " << subset;
}

void expect_sounding(const test::OracleMessage& message, std::size_t subset, const AmsuaSounding& s) {
  const CivilTime time = to_civil(s.view.time_ms);
  expect_number(message, "#1#satelliteIdentifier", subset, kNoaa16, 0);
  expect_number(message, "#1#satelliteSensorIndicator", subset, 3, 0);
  expect_number(message, "#1#orbitNumber", subset, s.orbit_number, 0);
  expect_number(message, "#1#scanLineNumber", subset, s.scan_line, 0);
  expect_number(message, "#1#fieldOfViewNumber", subset, s.field_of_view, 0);
  expect_number(message, "#1#year", subset, time.year, 0);
  expect_number(message, "#1#month", subset, time.month, 0);
  expect_number(message, "#1#day", subset, time.day, 0);
  expect_number(message, "#1#hour", subset, time.hour, 0);
  expect_number(message, "#1#minute", subset, time.minute, 0);
  expect_number(message, "#1#second", subset, time.second, 0);
  expect_number(message, "#1#latitude", subset, s.view.latitude_deg, 1e-5);
  expect_number(message, "#1#longitude", subset, s.view.longitude_deg, 1e-5);
  expect_number(message, "#1#heightOfStation", subset, s.view.satellite_height_km * 1000, 100);
  expect_number(message, "#1#satelliteZenithAngle", subset, s.view.satellite_zenith_deg, 0.01);
  expect_number(message, "#1#bearingOrAzimuth", subset, s.view.satellite_azimuth_deg, 0.01);
  expect_number(message, "#1#solarZenithAngle", subset, s.view.solar_zenith_deg, 0.01);
  expect_number(message, "#1#solarAzimuth", subset, s.view.solar_azimuth_deg, 0.01);
  for (int channel = 1; channel <= kAmsuaChannels; ++channel) {
    const std::string rank = "#" + std::to_string(channel) + "#";
    expect_number(message, rank + "tovsOrAtovsOrAvhrrInstrumentationChannelNumber", subset, 27 + channel, 0);
    expect_number(message, rank + "brightnessTemperature", subset,
                  s.brightness_temperature_k[static_cast<std::size_t>(channel - 1)], 0.01);
    expect_number(message, rank + "channelQualityFlagsForAtovs", subset, 0, 0);
  }
  // In inverse metres: channel 1 as real files have it, channel 15 from 89 GHz.
  expect_number(message, "#1#log10OfTemperatureRadianceCentralWaveNumberForAtovs", subset, 1.8997565, 1e-6);
  expect_number(message, "#15#log10OfTemperatureRadianceCentralWaveNumberForAtovs", subset,
                std::log10(89 / 0.299792458), 1e-8);
}

TEST_F(BufrAmsuaWriter, EcCodesReadsEveryKeyBack) {
  const auto soundings = random_soundings(7, 1);
  const auto summary = write_amsua_file(path(), kNoaa16, soundings, {.lines_per_message = 3});
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->messages, 3U);
  EXPECT_EQ(summary->bytes, std::filesystem::file_size(path()));

  const auto messages = test::decode_file_slowly(path());
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].subset_count, 90U);
  EXPECT_EQ(messages[2].subset_count, 30U);
  std::size_t next = 0;
  for (const test::OracleMessage& message : messages)
    for (std::size_t subset = 0; subset < message.subset_count; ++subset)
      expect_sounding(message, subset, soundings.at(next++));
  EXPECT_EQ(next, soundings.size());
}

TEST_F(BufrAmsuaWriter, HeadersSayWhatItIs) {
  ASSERT_TRUE(write_amsua_file(path(), kNoaa16, random_soundings(5, 2), {}));
  const auto messages = test::decode_file_slowly(path());
  ASSERT_EQ(messages.size(), 1U);
  const auto number = [&](const std::string& key) { return std::stod(messages[0].header.at(key)); };
  EXPECT_EQ(number("edition"), 4);
  EXPECT_EQ(number("masterTablesVersionNumber"), 13);
  EXPECT_EQ(number("unexpandedDescriptors"), 310009);
  EXPECT_EQ(number("compressedData"), 1);
  EXPECT_EQ(number("dataCategory"), 3);
  EXPECT_EQ(number("typicalYear"), 2004);
  EXPECT_EQ(number("typicalMonth"), 12);
  EXPECT_EQ(number("typicalDay"), 31);
  EXPECT_EQ(number("typicalHour"), 23);
  EXPECT_EQ(number("typicalMinute"), 59);
  EXPECT_EQ(number("bufrHeaderCentre"), 65535);  // missing: no centre measured this
}

TEST_F(BufrAmsuaWriter, OurOwnReaderReadsItToo) {
  const auto soundings = random_soundings(8, 3);
  for (const bool gts : {false, true}) {
    ASSERT_TRUE(write_amsua_file(path(), kNoaa16, soundings, {.lines_per_message = 3, .gts_envelopes = gts}));
    const auto read = read_observations(path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE(read->skipped.empty());
    ASSERT_EQ(read->observations.size(), soundings.size());
    for (std::size_t i = 0; i < soundings.size(); ++i) {
      EXPECT_EQ(read->observations.time_ms[i], soundings[i].view.time_ms);
      EXPECT_NEAR(read->observations.latitude_deg[i], soundings[i].view.latitude_deg, 0.6e-5);
      EXPECT_EQ(read->observations.scan_line[i], soundings[i].scan_line);
    }
  }
}

TEST_F(BufrAmsuaWriter, BulletinsCountTheirBytes) {
  const auto soundings = random_soundings(4, 4);
  ASSERT_TRUE(write_amsua_file(path(), kNoaa16, soundings, {.lines_per_message = 2, .gts_envelopes = true}));
  const std::string bytes = bytes_of(path());
  std::size_t at = 0;
  for (const std::string number : {"001", "002"}) {
    const std::size_t length = std::stoul(bytes.substr(at, 8));
    EXPECT_EQ(bytes.substr(at + 8, 2), "00");
    const std::string bulletin = bytes.substr(at + 10, length);
    ASSERT_EQ(bulletin.size(), length);
    EXPECT_EQ(bulletin.substr(0, 31), "\x01\r\r\n" + number + "\r\r\nINAX01 SYNT 312359\r\r\n");
    EXPECT_EQ(bulletin.substr(31, 4), "BUFR");
    EXPECT_EQ(bulletin.substr(length - 8), "7777\r\r\n\x03");
    at += 10 + length;
  }
  EXPECT_EQ(at, bytes.size());
}

TEST_F(BufrAmsuaWriter, SameSoundingsGiveTheSameBytesAndNothingElse) {
  const std::string other = (folder_ / "other.bufr").string();
  ASSERT_TRUE(write_amsua_file(path(), kNoaa16, random_soundings(5, 5), {}));
  ASSERT_TRUE(write_amsua_file(other, kNoaa16, random_soundings(5, 5), {}));
  EXPECT_EQ(bytes_of(path()), bytes_of(other));
  ASSERT_TRUE(write_amsua_file(other, kNoaa16, random_soundings(5, 6), {}));
  EXPECT_NE(bytes_of(path()), bytes_of(other));
  // No temporary file is left.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 2);
}

TEST_F(BufrAmsuaWriter, FailureNamesTheFile) {
  const std::string nowhere = (folder_ / "no such folder" / "soundings.bufr").string();
  const auto summary = write_amsua_file(nowhere, kNoaa16, random_soundings(1, 7), {});
  ASSERT_FALSE(summary);
  EXPECT_NE(summary.error().message.find("no such folder"), std::string::npos) << summary.error().message;
}

}  // namespace
}  // namespace thin
