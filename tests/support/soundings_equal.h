#pragma once

// Observations beside their file as the oracle decodes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libthin/observations/observation_set.h"
#include "tests/support/bufr_oracle.h"

namespace thin::test {

// Every subset of every message is there, in order, equal to the last bit.
inline void expect_equal_to_oracle(const ObservationSet& set, const std::vector<OracleMessage>& messages) {
  std::size_t i = 0;
  for (std::uint32_t number = 0; number < messages.size(); ++number) {
    for (std::uint32_t subset = 0; subset < messages[number].subset_count; ++subset, ++i) {
      ASSERT_LT(i, set.size());
      const OracleSounding sounding = oracle_sounding(messages[number], subset);
      ASSERT_EQ(set.source[i], (SourceReference{0, number, subset}));
      // The edges of the map decode to a rounding beyond them.
      EXPECT_EQ(set.latitude_deg[i], std::clamp(sounding.latitude_deg, -90.0, 90.0));
      EXPECT_EQ(set.longitude_deg[i], std::clamp(sounding.longitude_deg, -180.0, 360.0));
      EXPECT_EQ(set.time_ms[i], sounding.time_ms);
      EXPECT_EQ(set.platform[i], sounding.platform);
      EXPECT_EQ(set.scan_line[i], sounding.scan_line);
      EXPECT_EQ(set.field_of_view[i], sounding.field_of_view);
      for (std::size_t channel = 0; channel < 15; ++channel) {
        const double value_k = set.values_of(i)[channel];
        const double expected_k = sounding.temperature_k[channel];
        EXPECT_TRUE(value_k == expected_k || (std::isnan(value_k) && std::isnan(expected_k)))
            << "message " << number << " subset " << subset << " channel " << channel + 1;
      }
    }
  }
  EXPECT_EQ(i, set.size());
}

}  // namespace thin::test
