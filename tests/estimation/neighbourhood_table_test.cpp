#include "libthin/estimation/neighbourhood_table.h"

#include <gtest/gtest.h>

#include "libthin/estimation/gme_grid.h"
#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(NeighbourhoodTable, HoldsEveryPairWithinThreeBandwidthsAndNoOther) {
  const ObservationSet set = test::random_observations(300, 1, 1);
  const std::vector<Vector3> grid = gme_grid(5);
  const GaussianFilter filter{120};
  std::vector<std::uint32_t> kept;
  const auto table = neighbourhood_table(grid, set.position_km, filter, &kept);
  ASSERT_TRUE(table);

  std::size_t row = 0, entry = 0;
  for (std::uint32_t q = 0; q < grid.size(); ++q) {
    const std::size_t first = entry;
    for (std::uint32_t p = 0; p < set.size(); ++p) {
      const double distance_km = chord_km(grid[q], set.position_km[p]);
      if (distance_km > filter.radius_km()) continue;
      ASSERT_EQ(table->observation[entry], p);
      EXPECT_NEAR(table->weight[entry], std::exp(-std::pow(distance_km / 120, 2)), 1e-12);
      ++entry;
    }
    if (entry == first) continue;
    ASSERT_EQ(kept[row], q);
    ++row;
    ASSERT_EQ(table->row_begin[row], entry);
  }
  EXPECT_EQ(row, table->evaluation_point_count());
  EXPECT_EQ(entry, table->entry_count());
  EXPECT_GT(entry, 1000U);
}

TEST(NeighbourhoodTable, ColumnsAreTheSameEntriesByObservation) {
  const ObservationSet set = test::random_observations(200, 1, 2);
  const auto table = neighbourhood_table(set.position_km, set.position_km, {80});
  ASSERT_TRUE(table);
  ASSERT_EQ(table->column_begin.size(), set.size() + 1);
  std::vector<std::uint64_t> next(table->column_begin.begin(), table->column_begin.end() - 1);
  for (std::size_t q = 0; q < table->evaluation_point_count(); ++q)
    for (std::uint64_t entry = table->row_begin[q]; entry < table->row_begin[q + 1]; ++entry) {
      const std::uint64_t place = next[table->observation[entry]]++;
      EXPECT_EQ(table->evaluation_point[place], q);
      EXPECT_EQ(table->column_weight[place], table->weight[entry]);
    }
  for (std::size_t p = 0; p < set.size(); ++p) EXPECT_EQ(next[p], table->column_begin[p + 1]);
}

TEST(NeighbourhoodTable, IsTheSameForAnyNumberOfThreads) {
  const ObservationSet set = test::random_observations(2000, 1, 3);
  const auto build = [&](int threads) {
    const ThreadLimit limit(threads);
    return *neighbourhood_table(set.position_km, set.position_km, {50});
  };
  const NeighbourhoodTable one = build(1), two = build(2);
  EXPECT_EQ(one.row_begin, two.row_begin);
  EXPECT_EQ(one.observation, two.observation);
  EXPECT_EQ(one.weight, two.weight);
  EXPECT_EQ(one.evaluation_point, two.evaluation_point);
}

TEST(NeighbourhoodTable, OfNothingIsEmpty) {
  const auto table = neighbourhood_table(gme_grid(2), {}, {100});
  ASSERT_TRUE(table);
  EXPECT_EQ(table->evaluation_point_count(), 0U);
  EXPECT_EQ(table->observation_count(), 0U);
}

}  // namespace
}  // namespace thin
