#include <gtest/gtest.h>

#include <map>

#include "libthin/estimation/gme_grid.h"
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

TEST(Box, OnTheGmeGridRetainsTheNearestToEachVertex) {
  for (const test::Region region : {test::Region{-90, 90, -180, 180}, test::Region{80, 90, 0, 360}})
    for (const std::int64_t level : {0, 2, 4}) {
      const ObservationSet set = test::random_observations(500, 1, 3, region);
      const std::vector<Vector3> grid = gme_grid(static_cast<int>(level));
      std::map<std::size_t, std::uint32_t> nearest_of;  // by vertex
      for (std::uint32_t i = 0; i < set.size(); ++i) {
        std::size_t vertex = 0;
        for (std::size_t v = 1; v < grid.size(); ++v)
          if (chord_km(set.position_km[i], grid[v]) < chord_km(set.position_km[i], grid[vertex])) vertex = v;
        const auto [place, is_first] = nearest_of.try_emplace(vertex, i);
        if (!is_first &&
            chord_km(set.position_km[i], grid[vertex]) < chord_km(set.position_km[place->second], grid[vertex]))
          place->second = i;
      }
      Retained expected;
      for (const auto& [vertex, observation] : nearest_of) expected.push_back(observation);
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(test::retained(test::thinner("box", {{"grid", std::string("gme")}, {"level", level}}), set), expected);
    }
}

}  // namespace
}  // namespace thin
