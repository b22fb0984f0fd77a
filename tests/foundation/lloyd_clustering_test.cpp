#include "libthin/foundation/lloyd_clustering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "libthin/foundation/parallel.h"
#include "tests/support/clustering_oracle.h"
#include "tests/support/random_points.h"

namespace thin {
namespace {

ClusterPoints points_of(const test::PointCloud& cloud, int dimension, int place_dimension = 3) {
  return {.coordinates = cloud.coordinates, .dimension = dimension, .place_dimension = place_dimension};
}

std::vector<std::size_t> sizes_of(const Clustering& clustering) {
  std::vector<std::size_t> sizes(clustering.size());
  for (const std::uint32_t cluster : clustering.cluster_of) ++sizes[cluster];
  return sizes;
}

TEST(SplitClusters, GivesAsManyAsAskedForAndMeansOfLeastError) {
  for (const int dimension : {3, 5, 20})
    for (const auto& cloud : test::awkward_clouds(150, dimension, 1))
      for (const std::size_t count : {1U, 2U, 7U, 40U, 150U, 400U}) {
        SCOPED_TRACE(cloud.name + ", " + std::to_string(count) + " of dimension " + std::to_string(dimension));
        const ClusterPoints points = points_of(cloud, dimension);
        const test::ClusteringOracle oracle{points};
        const Clustering clustering = split_clusters(points, {.cluster_count = count});
        ASSERT_EQ(clustering.size(), std::min(count, points.size()));
        const auto sizes = sizes_of(clustering);
        for (std::uint32_t cluster = 0; cluster < clustering.size(); ++cluster) {
          ASSERT_GT(sizes[cluster], 0U);
          ASSERT_EQ(clustering.cluster_of[clustering.representative[cluster]], cluster);
          const double least = oracle.least_error(clustering, cluster);
          ASSERT_LE(oracle.error(clustering, cluster, clustering.representative[cluster]), least * (1 + 1e-9) + 1e-12);
        }
      }
}

TEST(SplitClusters, SplitsTheLargestErrorFirst) {
  const auto clouds = test::awkward_clouds(120, 4, 2);
  const ClusterPoints points = points_of(clouds.front(), 4);
  const test::ClusteringOracle oracle{points};
  for (std::size_t count = 1; count < 60; ++count) {
    const Clustering before = split_clusters(points, {.cluster_count = count});
    const Clustering after = split_clusters(points, {.cluster_count = count + 1});
    std::set<std::uint32_t> changed;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (before.cluster_of[p] != after.cluster_of[p]) changed.insert(before.cluster_of[p]);
    ASSERT_EQ(changed.size(), 1U);
    const double error = oracle.least_error(before, *changed.begin());
    for (std::uint32_t cluster = 0; cluster < count; ++cluster)
      ASSERT_LE(oracle.least_error(before, cluster), error * (1 + 1e-9));
  }
}

TEST(SplitClusters, StopsWhereNoErrorExceedsTheBound) {
  for (const auto& cloud : test::awkward_clouds(100, 3, 3))
    for (const double bound : {0.0, 0.1, 1.0, 1e6}) {
      SCOPED_TRACE(cloud.name);
      const ClusterPoints points = points_of(cloud, 3);
      const test::ClusteringOracle oracle{points};
      const Clustering clustering = split_clusters(points, {.cluster_count = 100, .cluster_error = bound});
      for (std::uint32_t cluster = 0; cluster < clustering.size(); ++cluster)
        ASSERT_LE(oracle.least_error(clustering, cluster), bound * (1 + 1e-9) + 1e-12);
      if (bound == 1e6) {
        EXPECT_LE(clustering.size(), 1U);
      }
      if (cloud.name == "all equal") {
        EXPECT_EQ(clustering.size(), 1U);
      }
    }
}

TEST(SplitClusters, TakesEqualPointsForOneWhateverTheirCentroidRoundsTo) {
  std::vector<double> coordinates;
  for (int i = 0; i < 7; ++i) coordinates.insert(coordinates.end(), {6378.137 / 3, 0.1, 1e3 / 7, 100.0 / 3});
  const ClusterPoints points{.coordinates = coordinates, .dimension = 4};
  EXPECT_EQ(split_clusters(points, {.cluster_count = 7, .cluster_error = 0}).size(), 1U);
  EXPECT_EQ(split_clusters(points, {.cluster_count = 7}).size(), 7U);
}

TEST(RelaxClusters, IsEveryRoundWhatTryingAllGives) {
  for (const int dimension : {3, 8, 19})
    for (const auto& cloud : test::awkward_clouds(180, dimension, 4)) {
      if (cloud.name == "lattice" || cloud.name == "duplicates") continue;  // many ties but for rounding: below
      SCOPED_TRACE(cloud.name + " of dimension " + std::to_string(dimension));
      const ClusterPoints points = points_of(cloud, dimension);
      const test::ClusteringOracle oracle{points};
      Clustering expected = split_clusters(points, {.cluster_count = 25}), clustering = expected;
      for (int round = 0; round < 30; ++round) {
        const bool any = oracle.round(expected);
        ASSERT_EQ(relax_clusters(points, clustering, 1), any ? 1 : 0) << round;
        ASSERT_EQ(clustering.cluster_of, expected.cluster_of) << round;
        ASSERT_EQ(clustering.representative, expected.representative) << round;
        if (!any) break;
      }
      Clustering at_once = split_clusters(points, {.cluster_count = 25});
      relax_clusters(points, at_once, 30);
      EXPECT_EQ(at_once.cluster_of, expected.cluster_of);
    }
}

TEST(RelaxClusters, EndsWhereEveryPointIsWithItsNearestRepresentative) {
  for (const int place_dimension : {3, 4})
    for (const auto& cloud : test::awkward_clouds(300, 6, 5)) {
      SCOPED_TRACE(cloud.name);
      const ClusterPoints points = points_of(cloud, 6, place_dimension);
      const test::ClusteringOracle oracle{points};
      Clustering clustering = split_clusters(points, {.cluster_count = 40});
      const double before = sum_of_cluster_errors(points, clustering);
      EXPECT_LT(relax_clusters(points, clustering, 200), 200);
      EXPECT_LE(sum_of_cluster_errors(points, clustering), before);
      for (const std::size_t size : sizes_of(clustering)) EXPECT_GT(size, 0U);
      for (std::size_t p = 0; p < points.size(); ++p) {
        const double own = oracle.distance_squared(p, clustering.representative[clustering.cluster_of[p]]);
        for (const std::uint32_t other : clustering.representative)
          ASSERT_GE(oracle.distance_squared(p, other), own * (1 - 1e-12));
      }
    }
}

TEST(RelaxClusters, KeepsGroupsApart) {
  const auto clouds = test::awkward_clouds(200, 5, 6);
  std::vector<std::uint8_t> group(200);
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<std::uint8_t>(i % 3 ? 4 : 9);
  ClusterPoints points = points_of(clouds.front(), 5);
  points.group = group;
  Clustering expected = split_clusters(points, {.cluster_count = 20}), clustering = expected;
  const test::ClusteringOracle oracle{points};
  while (oracle.round(expected)) {
  }
  relax_clusters(points, clustering, 100);
  EXPECT_EQ(clustering.cluster_of, expected.cluster_of);
  for (std::size_t p = 0; p < group.size(); ++p)
    EXPECT_EQ(group[p], group[clustering.representative[clustering.cluster_of[p]]]);
  EXPECT_EQ(split_clusters(points, {.cluster_count = 1}).size(), 2U);  // one for each group, whatever the goal
}

TEST(RelaxClusters, IsTheSameForAnyNumberOfThreads) {
  const auto clouds = test::awkward_clouds(3000, 11, 7);
  const ClusterPoints points = points_of(clouds.front(), 11);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    Clustering clustering = split_clusters(points, {.cluster_count = 300});
    relax_clusters(points, clustering, 100);
    return clustering.cluster_of;
  };
  EXPECT_EQ(with_threads(1), with_threads(4));
}

}  // namespace
}  // namespace thin
