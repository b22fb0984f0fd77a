#include <gtest/gtest.h>

#include "libthin/observations/geodesy.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

TEST(Box, BoxesHaveNearlyEqualArea) {
  // 200,000 even points: a mesh of 500 km must keep about one for each 250,000 km² of the Earth's 510 million.
  const ObservationSet set = test::spiral_observations(200000, 1, 1);
  const Retained retained = test::retained(test::thinner("box", {{"horizontal_mesh", 500.0}}), set);
  EXPECT_NEAR(static_cast<double>(retained.size()), 510.07e6 / 250000, 20);
}

TEST(Box, SpreadsOverTheDateLineLikeAnywhereElse) {
  const Thinner box = test::thinner("box", {});
  const ObservationSet west = test::random_observations(3000, 1, 2, {-10, 10, 178, 182});
  ObservationSet turned = test::random_observations(0, 1, 2);
  for (std::size_t i = 0; i < west.size(); ++i)  // the same places, spelt from -180
    turned.push_back({.latitude_deg = west.latitude_deg[i],
                      .longitude_deg = normalised_longitude_deg(west.longitude_deg[i]),
                      .source = {}},
                     west.values_of(i));
  EXPECT_EQ(test::retained(box, west), test::retained(box, turned));
}

}  // namespace
}  // namespace thin
