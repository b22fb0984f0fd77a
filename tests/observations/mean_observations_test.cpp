#include "libthin/observations/mean_observations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

TEST(MeanObservations, AreMeansOfWhatIsThereAndKeepWhatAllShare) {
  ObservationSet set;
  set.channels = {5, 6};
  const double missing = std::numeric_limits<double>::quiet_NaN();
  set.push_back(
      {.latitude_deg = 10, .longitude_deg = 179, .time_ms = 1000, .platform = 4, .surface = Surface::sea, .source = {}},
      std::vector<double>{1, missing});
  set.push_back({.latitude_deg = 10,
                 .longitude_deg = -179,
                 .time_ms = 2001,
                 .platform = 4,
                 .surface = Surface::land,
                 .source = {}},
                std::vector<double>{2, 7});
  set.push_back({.latitude_deg = -80, .longitude_deg = 20, .time_ms = 5, .platform = 223, .source = {}},
                std::vector<double>{-3, missing});
  set.first_guess_k = {1, 1, 3, 1, 0, 0};
  const std::vector<std::vector<std::uint32_t>> groups = {{0, 1}, {2}};
  const ObservationSet means = mean_observations(set, groups);
  ASSERT_EQ(means.size(), 2U);
  EXPECT_EQ(means.values[0], 1.5);
  EXPECT_EQ(means.values[1], 7);
  EXPECT_EQ(means.values[2], -3);
  EXPECT_TRUE(std::isnan(means.values[3]));
  EXPECT_EQ(means.first_guess_k, (std::vector<double>{2, 1, 0, 0}));
  EXPECT_NEAR(normalised_longitude_deg(means.longitude_deg[0] - 180), 0, 1e-9);
  EXPECT_NEAR(means.latitude_deg[0], 10, 0.01);
  EXPECT_NEAR(chord_km(means.position_km[1], set.position_km[2]), 0, 1e-6);
  EXPECT_EQ(means.time_ms, (std::vector<std::int64_t>{1501, 5}));
  EXPECT_EQ(means.platform, (std::vector<std::int32_t>{4, 223}));
  EXPECT_EQ(means.surface[0], Surface::unknown);
  EXPECT_EQ(means.variables.at(kMeanOf), (std::vector<double>{2, 1}));
}

}  // namespace
}  // namespace thin
