#include "libthin/formats/cf_writer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/formats/observation_file.h"
#include "tests/support/bufr_messages.h"
#include "tests/support/netcdf_files.h"
#include "tests/support/netcdf_oracle.h"

namespace thin {
namespace {

ObservationSet some_observations() {
  ObservationSet set;
  for (int channel = 1; channel <= 15; ++channel) set.channels.push_back(channel);
  std::vector<double> zenith;
  for (std::size_t i = 0; i < 40; ++i) {
    ObservationSet::Entry entry;
    entry.latitude_deg = test::latitude_of(i);
    entry.longitude_deg = test::longitude_of(i);
    entry.time_ms = 1639256400125 + 1000 * static_cast<std::int64_t>(i);
    entry.platform = 223;
    entry.instrument = Instrument::amsua;
    entry.scan_line = i == 5 ? kUnknownNumber : static_cast<std::int32_t>(i / 30);
    entry.field_of_view = static_cast<std::int32_t>(i % 30 + 1);
    entry.surface = static_cast<Surface>(i % 5);
    std::vector<double> row;
    for (std::size_t c = 0; c < 15; ++c) {
      const double observed = test::observed_of(i, c);
      row.push_back(test::is_rejected(i, c) ? test::kNoValue : observed);
      set.first_guess_k.push_back(observed - test::innovation_of(i, c));
    }
    const std::vector<double> guess = std::move(set.first_guess_k);
    set.first_guess_k.clear();
    set.push_back(entry, row);
    set.first_guess_k = guess;
    zenith.push_back(0.25 * static_cast<double>(i));
  }
  set.variables["satellite_zenith_angle_deg"] = zenith;
  return set;
}

TEST(CfWriter, WhatIsWrittenIsReadAgain) {
  const test::ScratchFolder folder;
  const ObservationSet set = some_observations();
  const auto bytes = write_cf_file(folder.path("a.nc"), set);
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  EXPECT_EQ(*bytes, test::read_bytes(folder.path("a.nc")).size());
  ASSERT_TRUE(write_cf_file(folder.path("b.nc"), set).ok());
  EXPECT_TRUE(test::read_bytes(folder.path("a.nc")) == test::read_bytes(folder.path("b.nc")));

  const auto contents = read_observations(folder.path("a.nc"));
  ASSERT_TRUE(contents.ok()) << contents.error().message;
  EXPECT_EQ(contents->layout, "cf");
  EXPECT_EQ(contents->instrument, "AMSU-A");
  EXPECT_EQ(contents->notes.front(), "innovations: toa_brightness_temperature - first_guess_brightness_temperature");
  const ObservationSet& again = contents->observations;
  EXPECT_EQ(again.channels, set.channels);
  EXPECT_EQ(again.latitude_deg, set.latitude_deg);
  EXPECT_EQ(again.longitude_deg, set.longitude_deg);
  EXPECT_EQ(again.time_ms, set.time_ms);
  EXPECT_EQ(again.platform, set.platform);
  EXPECT_EQ(again.scan_line, set.scan_line);
  EXPECT_EQ(again.field_of_view, set.field_of_view);
  EXPECT_EQ(again.surface, set.surface);
  EXPECT_EQ(again.first_guess_k, set.first_guess_k);
  EXPECT_EQ(again.variables.at("satellite_zenith_angle_deg"), set.variables.at("satellite_zenith_angle_deg"));
  for (std::size_t i = 0; i < set.values.size(); ++i)
    EXPECT_TRUE(again.values[i] == set.values[i] || (std::isnan(again.values[i]) && std::isnan(set.values[i])));
}

TEST(CfWriter, IsWhatThePageSays) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_cf_file(folder.path("a.nc"), some_observations()).ok());
  const std::string header = test::output_of("ncdump -h '" + folder.path("a.nc") + "'");
  for (const char* part :
       {":featureType = \"point\"", ":Conventions = \"CF-1.8\"", "obs = 40", "channel = 15",
        "float brightness_temperature(obs, channel)",
        "brightness_temperature:standard_name = \"toa_brightness_temperature\"", "lat:standard_name = \"latitude\"",
        "lon:standard_name = \"longitude\"", "time:units = \"seconds since 1970-01-01 00:00:00\"",
        "int satellite_identifier(obs)", "brightness_temperature:coordinates = \"time lat lon\"",
        "satellite_zenith_angle_deg:standard_name = \"sensor_zenith_angle\""})
    EXPECT_NE(header.find(part), std::string::npos) << part << "\n" << header;
}

TEST(CfWriter, LeavesNothingWhereItCannotWrite) {
  const test::ScratchFolder folder;
  const auto refused = write_cf_file(folder.path("no/folder.nc"), some_observations());
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("No such file or directory"), std::string::npos);
}

}  // namespace
}  // namespace thin
