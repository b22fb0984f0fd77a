#include "libthin/estimation/analysis_target.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/observations/geodesy.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(AnalysisTarget, EstimatesAreTheFiltersFromAll) {
  const ObservationSet set = test::random_observations(200, 2, 1);
  const std::vector<std::uint32_t> points = {3, 50, 199};
  const std::vector<double> estimates = filter_estimates(places_of(set), set.values, 2, points, {150});
  const test::EstimationOracle oracle{{}, set.position_km, set.values, 2, 150};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto expected = oracle.estimate(set.position_km[points[i]], std::vector<bool>(200, true));
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(estimates[i * 2 + c], expected[c], 1e-12);
  }
}

TEST(AnalysisTarget, SpreadPlacesKeepApartAndLeaveNoGap) {
  const ObservationSet set = test::random_observations(500, 1, 2);
  for (const double spacing_km : {0.0, 120.0, 400.0}) {
    const std::vector<std::uint32_t> chosen = spread_places(places_of(set), spacing_km);
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      bool is_near = false;
      for (const std::uint32_t j : chosen) {
        const double distance_km = chord_km(set.position_km[i], set.position_km[j]);
        is_near = is_near || distance_km <= spacing_km;
        if (i != j && std::binary_search(chosen.begin(), chosen.end(), i)) {
          EXPECT_GT(distance_km, spacing_km);
        }
      }
      EXPECT_TRUE(is_near);
    }
  }
}

TEST(AnalysisTarget, LimitsOfSeveralChannelsRaiseNoMoreFalseAlarms) {
  EXPECT_NEAR(limit_for_channels(3, 1), 3, 1e-8);
  for (const std::size_t channels : {2U, 12U}) {
    const double limit = limit_for_channels(3, channels);
    EXPECT_NEAR(std::erfc(limit / std::sqrt(2.0)) * static_cast<double>(channels), std::erfc(3 / std::sqrt(2.0)), 1e-9);
  }
}

TEST(AnalysisTarget, GrossErrorsAreThoseThatNeighboursContradictAndNotTheNeighbours) {
  ObservationSet set = test::random_observations(2000, 2, 3);
  std::vector<std::uint8_t> planted(set.size(), 0);
  for (std::size_t i = 20; i < set.size(); i += 97) {
    set.values[2 * i + i % 2] += 8;
    planted[i] = 1;
  }
  EXPECT_EQ(gross_errors(places_of(set), set.values, 2, {80}, 5), planted);
  // One that stands alone is believed.
  ObservationSet far = test::random_observations(300, 2, 4);
  far.push_back({.latitude_deg = 60, .longitude_deg = 0, .source = {}}, std::vector<double>{50, 50});
  EXPECT_EQ(gross_errors(places_of(far), far.values, 2, {80}, 5).back(), 0);
}

}  // namespace
}  // namespace thin
