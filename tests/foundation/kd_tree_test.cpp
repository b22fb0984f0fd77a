#include "libthin/foundation/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_points.h"

namespace thin {
namespace {

double distance_squared(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

std::vector<Neighbour> all_by_index(std::span<const double> points, std::span<const double> query) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i * query.size() < points.size(); ++i)
    all.push_back(
        {static_cast<std::uint32_t>(i), distance_squared(query, points.subspan(i * query.size(), query.size()))});
  return all;
}

std::vector<Neighbour> brute_radius(std::span<const double> points, std::span<const double> query, double radius) {
  std::vector<Neighbour> all = all_by_index(points, query);
  std::erase_if(all, [&](const Neighbour& n) { return n.distance_squared > radius * radius; });
  return all;
}

std::vector<Neighbour> brute_nearest(std::span<const double> points, std::span<const double> query, std::size_t count) {
  std::vector<Neighbour> all = all_by_index(points, query);
  std::stable_sort(all.begin(), all.end(),
                   [](const Neighbour& a, const Neighbour& b) { return a.distance_squared < b.distance_squared; });
  all.resize(std::min(count, all.size()));
  return all;
}

class KdTreeTest : public testing::TestWithParam<int> {};

TEST_P(KdTreeTest, AgreesWithBruteForce) {
  const int dimension = GetParam();
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (const auto& cloud : test::awkward_clouds(150, dimension, seed)) {
      SCOPED_TRACE(cloud.name + ", seed " + std::to_string(seed));
      const KdTree tree(cloud.coordinates, dimension);
      const auto queries = test::awkward_clouds(20, dimension, seed + 100);
      std::vector<Neighbour> found;
      for (const auto& query_cloud : {queries[0], queries[5], cloud})
        for (std::size_t q = 0; q < query_cloud.coordinates.size(); q += static_cast<std::size_t>(dimension) * 7) {
          const auto query = std::span(query_cloud.coordinates).subspan(q, dimension);
          for (const double radius : {0.0, 0.3, 1.0, 2.0, 100.0}) {
            tree.radius_search(query, radius, found);
            EXPECT_EQ(found, brute_radius(cloud.coordinates, query, radius)) << "radius " << radius;
          }
          for (const std::size_t count : {0U, 1U, 7U, 150U, 1000U}) {
            tree.nearest(query, count, found);
            EXPECT_EQ(found, brute_nearest(cloud.coordinates, query, count)) << "count " << count;
          }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, KdTreeTest, testing::Values(3, 4, 9, 16));

TEST(KdTree, TheBoundaryBelongsToTheRadius) {
  const std::vector<double> points = {0, 0, 0, 3, 4, 0, 0, 0, 5.0000001};
  const KdTree tree(points, 3);
  std::vector<Neighbour> found;
  tree.radius_search(std::vector<double>{0, 0, 0}, 5, found);
  EXPECT_EQ(found, (std::vector<Neighbour>{{0, 0.0}, {1, 25.0}}));
}

TEST(KdTree, NegativeAndNotANumberRadiusFindNothing) {
  const KdTree tree(std::vector<double>{0, 0, 0}, 3);
  std::vector<Neighbour> found = {{7, 7.0}};
  tree.radius_search(std::vector<double>{0, 0, 0}, -1, found);
  EXPECT_TRUE(found.empty());
  tree.radius_search(std::vector<double>{0, 0, 0}, std::nan(""), found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace thin
