#include "libthin/estimation/neighbourhood_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  const auto table = neighbourhood_table(places_at(grid), places_of(set), filter, &kept);
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
  const auto table = neighbourhood_table(places_of(set), places_of(set), {80});
  ASSERT_TRUE(table);
  ASSERT_EQ(table->column_begin.size(), set.size() + 1);
  std::vector<std::uint64_t> next(table->column_begin.begin(), table->column_begin.end() - 1);
  for (std::size_t q = 0; q < table->evaluation_point_count(); ++q)
    for (std::uint64_t entry = table->row_begin[q]; entry < table->row_begin[q + 1]; ++entry) {
      const std::uint64_t place = next[table->observation[entry]]++;
      EXPECT_EQ(table->column_point[place], q);
      EXPECT_EQ(table->column_weight[place], table->weight[entry]);
    }
  for (std::size_t p = 0; p < set.size(); ++p) EXPECT_EQ(next[p], table->column_begin[p + 1]);
}

TEST(NeighbourhoodTable, IsTheSameForAnyNumberOfThreads) {
  const ObservationSet set = test::random_observations(2000, 1, 3);
  const auto build = [&](int threads) {
    const ThreadLimit limit(threads);
    return *neighbourhood_table(places_of(set), places_of(set), {50});
  };
  const NeighbourhoodTable one = build(1), two = build(2);
  EXPECT_EQ(one.row_begin, two.row_begin);
  EXPECT_EQ(one.observation, two.observation);
  EXPECT_EQ(one.weight, two.weight);
  EXPECT_EQ(one.column_point, two.column_point);
}

TEST(NeighbourhoodTable, OfNothingIsEmpty) {
  const auto table = neighbourhood_table(places_at(gme_grid(2)), places_at({}), {100});
  ASSERT_TRUE(table);
  EXPECT_EQ(table->evaluation_point_count(), 0U);
  EXPECT_EQ(table->observation_count(), 0U);
}

TEST(NeighbourhoodTable, AtTheObservationsIsSymmetric) {
  const ObservationSet set = test::random_observations(400, 1, 4);
  const auto table = neighbourhood_table(places_of(set), {80});
  const auto rows = neighbourhood_table(places_of(set), places_of(set), {80});
  ASSERT_TRUE(table && rows);
  EXPECT_TRUE(table->is_symmetric());
  EXPECT_EQ(table->row_begin, rows->row_begin);
  EXPECT_EQ(table->observation, rows->column_point);
  EXPECT_EQ(table->weight, rows->column_weight);
  EXPECT_TRUE(std::ranges::equal(table->points_near(7), rows->points_near(7)));
}

TEST(NeighbourhoodTable, CountsTimeAsDistance) {
  ObservationSet set = test::random_observations(200, 1, 5);
  for (std::size_t i = 0; i < set.size(); ++i) set.time_ms[i] = static_cast<std::int64_t>(i * 60'000);
  const auto table = neighbourhood_table(places_of(set, 300), {120});
  ASSERT_TRUE(table);
  std::size_t entry = 0;
  for (std::uint32_t q = 0; q < set.size(); ++q)
    for (std::uint32_t p = 0; p < set.size(); ++p) {
      const double hours = (static_cast<double>(p) - static_cast<double>(q)) / 60;
      const double distance_km = std::hypot(chord_km(set.position_km[q], set.position_km[p]), 300 * hours);
      if (distance_km > 360) continue;
      ASSERT_EQ(table->observation[entry], p);
      EXPECT_NEAR(table->weight[entry++], std::exp(-std::pow(distance_km / 120, 2)), 1e-9);
    }
  EXPECT_EQ(entry, table->entry_count());
}

TEST(NeighbourhoodTable, KeepsGroupsApart) {
  ObservationSet set = test::random_observations(100, 2, 6);
  set.channel_instrument = {Instrument::amsua, Instrument::mhs};
  for (std::size_t i = 0; i < set.size(); ++i) set.instrument[i] = i % 3 ? Instrument::amsua : Instrument::mhs;
  const Places places = places_of(set), points = evaluation_places(gme_grid(4), places, 100);
  EXPECT_EQ(points.size(), 2 * gme_vertex_count(4));
  std::vector<std::uint32_t> kept;
  const auto table = neighbourhood_table(points, places, {150}, &kept);
  ASSERT_TRUE(table);
  ASSERT_GT(table->entry_count(), 100U);
  for (std::size_t q = 0; q < kept.size(); ++q)
    for (std::uint64_t entry = table->row_begin[q]; entry < table->row_begin[q + 1]; ++entry)
      EXPECT_EQ(places.group_of(table->observation[entry]), points.group_of(kept[q]));
}

TEST(NeighbourhoodTable, RefusesWhatDoesNotFitAndNamesTheRemedy) {
  const ObservationSet set = test::random_observations(2000, 1, 7);
  const auto table = neighbourhood_table(places_of(set), {500}, 10'000'000);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().kind, ErrorKind::configuration);
  EXPECT_NE(table.error().message.find("smaller bandwidth_km"), std::string::npos) << table.error().message;
}

}  // namespace
}  // namespace thin
