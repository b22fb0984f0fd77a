#pragma once

// Observations beside their file as the oracle decodes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "libthin/observations/observation_set.h"
#include "tests/support/bufr_oracle.h"

namespace thin::test {

inline bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

inline void expect_equal_sounding(const ObservationSet& set, std::size_t i, const OracleSounding& sounding) {
  EXPECT_EQ(set.instrument[i], sounding.instrument);
  // The edges of the map decode to a rounding beyond them.
  EXPECT_EQ(set.latitude_deg[i], std::clamp(sounding.latitude_deg, -90.0, 90.0));
  EXPECT_EQ(set.longitude_deg[i], std::clamp(sounding.longitude_deg, -180.0, 360.0));
  EXPECT_EQ(set.time_ms[i], sounding.time_ms);
  EXPECT_EQ(set.platform[i], sounding.platform);
  EXPECT_EQ(set.scan_line[i], sounding.scan_line);
  EXPECT_EQ(set.field_of_view[i], sounding.field_of_view);
  const auto variable = [&](const char* name) {
    const auto found = set.variables.find(name);
    return found == set.variables.end() ? std::numeric_limits<double>::quiet_NaN() : found->second[i];
  };
  EXPECT_TRUE(same_number(variable("satellite_zenith_angle_deg"), sounding.satellite_zenith_deg));
  EXPECT_TRUE(same_number(variable("solar_zenith_angle_deg"), sounding.solar_zenith_deg));
  std::size_t present = 0;
  for (std::size_t place = 0; place < set.channel_count(); ++place) {
    const double value_k = set.values_of(i)[place];
    const auto expected = sounding.temperature_k.find(set.channels[place]);
    present += std::isnan(value_k) ? 0 : 1;
    EXPECT_TRUE(expected == sounding.temperature_k.end() ? std::isnan(value_k) : value_k == expected->second)
        << "channel " << set.channels[place];
  }
  EXPECT_EQ(present, sounding.temperature_k.size());
}

// Every subset of every message is there, in order, equal to the last bit.
inline void expect_equal_to_oracle(const ObservationSet& set, const std::vector<OracleMessage>& messages) {
  std::size_t i = 0;
  for (std::uint32_t number = 0; number < messages.size(); ++number) {
    for (std::uint32_t subset = 0; subset < messages[number].subset_count; ++subset, ++i) {
      SCOPED_TRACE("message " + std::to_string(number) + " subset " + std::to_string(subset));
      ASSERT_LT(i, set.size());
      ASSERT_EQ(set.source[i], (SourceReference{0, number, subset}));
      expect_equal_sounding(set, i, oracle_sounding(messages[number], subset));
    }
  }
  EXPECT_EQ(i, set.size());
}

// The same for files of compressed messages that are too long to be kept as text.
inline void expect_equal_to_keys(const ObservationSet& set, const std::filesystem::path& path,
                                 const std::string& temperature_key = "brightnessTemperature") {
  std::size_t i = 0;
  for_each_keyed_message(path, [&](std::uint32_t number, const KeyedMessage& message) {
    for (std::uint32_t subset = 0; subset < message.subset_count && !testing::Test::HasFailure(); ++subset, ++i) {
      SCOPED_TRACE("message " + std::to_string(number) + " subset " + std::to_string(subset));
      ASSERT_LT(i, set.size());
      ASSERT_EQ(set.source[i], (SourceReference{0, number, subset}));
      expect_equal_sounding(set, i, oracle_sounding(message, subset, temperature_key));
    }
  });
  EXPECT_EQ(i, set.size());
}

}  // namespace thin::test
