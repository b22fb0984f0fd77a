#include "libthin/thinning/octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

TEST(ProbabilityOfMore, AgreesWithTablesOfChiSquared) {
  struct Entry {
    double degrees_of_freedom, sum, probability;
  };
  for (const Entry& entry : {Entry{10, 18.307, 0.05}, Entry{10, 23.209, 0.01}, Entry{30, 43.773, 0.05},
                             Entry{100, 124.342, 0.05}, Entry{100, 99.334, 0.5}, Entry{20, 10.851, 0.95}})
    EXPECT_NEAR(probability_of_more(entry.sum, entry.degrees_of_freedom), entry.probability, 0.001);
  for (const Entry& entry : {Entry{1, 3.841, 0.05}, Entry{1, 0.455, 0.5}, Entry{2, 5.991, 0.05}, Entry{2, 0, 1}})
    EXPECT_NEAR(probability_of_more(entry.sum, entry.degrees_of_freedom), entry.probability, 0.01);
}

// The recursion with every cell as bounds that all observations are held against.
struct Oracle {
  const ObservationSet& set;
  double tolerance, significance, minimum_km, maximum_km;
  Retained retained = {};

  void visit(const std::array<double, 3>& low, double side) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      const Vector3& p = set.position_km[i];
      if (p.x >= low[0] && p.x < low[0] + side && p.y >= low[1] && p.y < low[1] + side && p.z >= low[2] &&
          p.z < low[2] + side)
        members.push_back(i);
    }
    if (members.empty()) return;
    if (members.size() == 1 || side / 2 < minimum_km || (side <= maximum_km && is_like_one(members))) {
      const auto squared = [&](std::uint32_t i) {
        const Vector3& p = set.position_km[i];
        return std::pow(p.x - low[0] - side / 2, 2) + std::pow(p.y - low[1] - side / 2, 2) +
               std::pow(p.z - low[2] - side / 2, 2);
      };
      retained.push_back(
          *std::min_element(members.begin(), members.end(), [&](auto a, auto b) { return squared(a) < squared(b); }));
      return;
    }
    for (int octant = 0; octant < 8; ++octant)
      visit({low[0] + (octant & 1 ? side / 2 : 0), low[1] + (octant & 2 ? side / 2 : 0),
             low[2] + (octant & 4 ? side / 2 : 0)},
            side / 2);
  }

  bool is_like_one(const std::vector<std::uint32_t>& members) const {
    double sum = 0;
    for (std::size_t c = 0; c < set.channel_count(); ++c) {
      double mean = 0;
      for (const std::uint32_t i : members) mean += set.values_of(i)[c];
      mean /= static_cast<double>(members.size());
      for (const std::uint32_t i : members) sum += std::pow((set.values_of(i)[c] - mean) / tolerance, 2);
    }
    const auto degrees = static_cast<double>((members.size() - 1) * set.channel_count());
    return probability_of_more(sum, degrees) >= significance;
  }
};

TEST(Octree, IsWhatBoundsOfCellsGive) {
  for (const test::Region region :
       {test::Region{}, test::Region{-90, 90, -180, 180}, test::Region{86, 90, 0, 360}, test::Region{10, 10, 20, 20}})
    for (const double tolerance : {0.2, 0.4, 5.0}) {
      const ObservationSet set = test::random_observations(500, 3, 1, region);
      Oracle oracle{set, tolerance, 0.05, 40, 1000};
      oracle.visit({-6400, -6400, -6400}, 12800);
      std::sort(oracle.retained.begin(), oracle.retained.end());
      const Thinner thinner = test::thinner(
          "octree", {{"value_tolerance", tolerance}, {"minimum_cell_km", 40.0}, {"maximum_cell_km", 1000.0}});
      EXPECT_EQ(test::retained(thinner, set), oracle.retained);
    }
}

TEST(Octree, IsDenseWhereTheSignalVaries) {
  // A step of 2 K along a meridian in the middle of a flat field.
  ObservationSet set = test::random_observations(4000, 1, 2, {-10, 10, 0, 40});
  std::size_t near_step = 0, retained_near_step = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.values[i] = set.longitude_deg[i] < 20 ? -1 : 1;
    near_step += std::abs(set.longitude_deg[i] - 20) < 3;
  }
  const Retained retained = test::retained(test::thinner("octree", {}), set);
  for (const std::uint32_t i : retained) retained_near_step += std::abs(set.longitude_deg[i] - 20) < 3;
  EXPECT_GT(static_cast<double>(retained_near_step) / static_cast<double>(retained.size()),
            3 * static_cast<double>(near_step) / static_cast<double>(set.size()));
}

TEST(Octree, RetainsByPriority) {
  ObservationSet set = test::random_observations(300, 1, 3, {10, 10.2, 10, 10.2});  // one cell
  std::fill(set.values.begin(), set.values.end(), 0.0);
  set.variables["rank"].assign(300, 0.0);
  set.variables["rank"][123] = 1;
  EXPECT_EQ(test::retained(test::thinner("octree", {{"priority_variable", std::string("rank")}}), set), Retained{123});
}

TEST(Octree, WantsTheLargestCellToBeDivisible) {
  const auto conflict = test::thinner("octree", {{"minimum_cell_km", 100.0}, {"maximum_cell_km", 150.0}}).conflict();
  ASSERT_TRUE(conflict);
  EXPECT_EQ(conflict->key, "maximum_cell_km");
}

}  // namespace
}  // namespace thin
