#include "libthin/thinning/top_down_clustering.h"

#include <gtest/gtest.h>

#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

// d² of eq. 6.8.
double distance_squared(const ObservationSet& set, std::size_t a, std::size_t b, double alpha_km_per_k) {
  const Vector3 &p = set.position_km[a], &q = set.position_km[b];
  double sum = (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z);
  for (std::size_t c = 0; c < set.channel_count(); ++c) {
    const double difference = alpha_km_per_k * (set.values_of(a)[c] - set.values_of(b)[c]);
    sum += difference * difference;
  }
  return sum;
}

// The clusters that retained observations stand for: everyone goes to the nearest.
double error_of(const ObservationSet& set, const Retained& retained, double alpha_km_per_k) {
  double sum = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    double nearest = HUGE_VAL;
    for (const std::uint32_t r : retained) nearest = std::min(nearest, distance_squared(set, i, r, alpha_km_per_k));
    sum += nearest;
  }
  return sum;
}

Retained clustered(const ObservationSet& set, std::int64_t count,
                   std::vector<std::pair<std::string, OptionValue>> options = {}) {
  options.emplace_back("retain_count", count);
  return test::retained(test::thinner("top_down_clustering", options), set);
}

TEST(TopDownClustering, RetainsTheMeanOfEachCluster) {
  const ObservationSet set = test::random_observations(400, 3, 1);
  for (const double alpha : {0.0, 100.0, 300.0}) {
    const Retained retained = clustered(set, 40, {{"alpha_km_per_k", alpha}});
    ASSERT_EQ(retained.size(), 40U);
    // Each stands for those that it is nearest to, with the least sum of squares of all of them.
    std::vector<std::vector<std::size_t>> members(retained.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
      std::size_t nearest = 0;
      for (std::size_t r = 1; r < retained.size(); ++r)
        if (distance_squared(set, i, retained[r], alpha) < distance_squared(set, i, retained[nearest], alpha))
          nearest = r;
      members[nearest].push_back(i);
    }
    for (std::size_t r = 0; r < retained.size(); ++r) {
      const auto squares = [&](std::size_t mean) {
        double sum = 0;
        for (const std::size_t i : members[r]) sum += distance_squared(set, i, mean, alpha);
        return sum;
      };
      for (const std::size_t other : members[r]) EXPECT_GE(squares(other), squares(retained[r]) * (1 - 1e-9));
    }
  }
}

TEST(TopDownClustering, LloydLowersTheError) {
  const ObservationSet set = test::random_observations(1000, 2, 2);
  const double split = error_of(set, clustered(set, 100, {{"lloyd_iterations", std::int64_t{0}}}), 100);
  const double relaxed = error_of(set, clustered(set, 100), 100);
  EXPECT_LT(relaxed, 0.98 * split);
}

TEST(TopDownClustering, StopsByTheErrorOfItsClusters) {
  const ObservationSet set = test::random_observations(500, 1, 3);
  EXPECT_FALSE(test::thinner("top_down_clustering", {{"cluster_error", 1e5}}).conflict());
  EXPECT_TRUE(test::thinner("top_down_clustering", {}).conflict());
  const auto size = [&](double bound) {
    return test::retained(test::thinner("top_down_clustering", {{"cluster_error", bound}}), set).size();
  };
  EXPECT_EQ(size(0), 500U);
  EXPECT_EQ(size(1e12), 1U);
  EXPECT_GT(size(1e5), size(1e6));
  EXPECT_EQ(clustered(set, 7, {{"cluster_error", 0.0}}).size(), 7U);
}

TEST(TopDownClustering, RetainsAsManyAsAskedForWhateverIsEqual) {
  ObservationSet equal = test::random_observations(50, 2, 4, {10, 10, 20, 20});
  for (const std::int64_t count : {0, 1, 2, 30, 50, 80})
    EXPECT_EQ(clustered(equal, count).size(), static_cast<std::size_t>(std::min<std::int64_t>(count, 50)));
  std::fill(equal.values.begin(), equal.values.end(), 1.0);
  for (const std::int64_t count : {0, 1, 2, 30, 50, 80})
    EXPECT_EQ(clustered(equal, count).size(), static_cast<std::size_t>(std::min<std::int64_t>(count, 50)));
}

TEST(TopDownClustering, RetainsByPriority) {
  ObservationSet set = test::random_observations(400, 2, 5);
  std::vector<double>& priority = set.variables["rank"];
  for (std::size_t i = 0; i < set.size(); ++i) priority.push_back(static_cast<double>(i % 7));
  const Retained without = clustered(set, 20), with = clustered(set, 20, {{"priority_variable", std::string("rank")}});
  const auto mean = [&](const Retained& retained) {
    double sum = 0;
    for (const std::uint32_t i : retained) sum += priority[i];
    return sum / static_cast<double>(retained.size());
  };
  ASSERT_EQ(with.size(), 20U);
  EXPECT_LT(mean(without), 4.5);
  EXPECT_GT(mean(with), 5.5);
}

TEST(TopDownClustering, TimeCountsAsADistance) {
  ObservationSet set = test::random_observations(200, 1, 8), later = set;
  for (std::int64_t& time_ms : later.time_ms) time_ms += 3 * 3'600'000;
  set.append(later);
  const auto early = [&](double time_scale) {
    const Retained retained = clustered(set, 40, {{"time_scale_km_per_hour", time_scale}});
    return std::count_if(retained.begin(), retained.end(), [](std::uint32_t i) { return i < 200; });
  };
  EXPECT_EQ(early(0), 40);  // every place twice, and of two the first
  EXPECT_NEAR(static_cast<double>(early(5000)), 20, 4);
}

TEST(TopDownClustering, InstrumentsShareNoCluster) {
  ObservationSet amsua = test::random_observations(100, 2, 6), mhs = test::random_observations(300, 1, 7);
  amsua.instrument.assign(100, Instrument::amsua);
  mhs.instrument.assign(300, Instrument::mhs);
  amsua.append(mhs);
  const ObservationSet set = amsua.select(canonical_order(amsua));
  const auto joint = [&](std::int64_t count) { return clustered(set, count, {{"instruments", std::string("joint")}}); };
  const Retained retained = joint(40);
  ASSERT_EQ(retained.size(), 40U);
  std::size_t of_mhs = 0;
  for (const std::uint32_t i : retained) of_mhs += set.instrument[i] == Instrument::mhs;
  EXPECT_GT(of_mhs, 10U);
  EXPECT_LT(of_mhs, 40U);
  const Retained one = joint(1);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(set.instrument[one.front()], Instrument::mhs);  // the larger group
}

}  // namespace
}  // namespace thin
