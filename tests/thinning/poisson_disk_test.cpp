#include "libthin/thinning/poisson_disk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

using Options = std::vector<std::pair<std::string, OptionValue>>;

// The exclusion volume by its definition; spacings <= 0 do not count.
struct Volume {
  double spacing_km = 0, spacing_s = 0;
  bool is_ellipsoid = false;

  Options options() const {
    Options all = {{"min_horizontal_spacing", spacing_km},
                   {"exclusion_volume_shape", std::string(is_ellipsoid ? "ellipsoid" : "cylinder")}};
    if (spacing_s > 0) all.emplace_back("min_time_spacing", "PT" + std::to_string(std::lround(spacing_s)) + "S");
    return all;
  }

  static double angle(const ObservationSet& set, std::size_t a, std::size_t b) {
    const double rad = std::numbers::pi / 180;
    const double over = std::sin((set.latitude_deg[a] - set.latitude_deg[b]) * rad / 2);
    const double along = std::sin((set.longitude_deg[a] - set.longitude_deg[b]) * rad / 2);
    const double cosines = std::cos(set.latitude_deg[a] * rad) * std::cos(set.latitude_deg[b] * rad);
    return 2 * std::asin(std::min(1.0, std::sqrt(over * over + cosines * along * along)));
  }

  bool excludes(const ObservationSet& set, std::size_t a, std::size_t b) const {
    const double seconds = static_cast<double>(std::abs(set.time_ms[a] - set.time_ms[b])) / 1000;
    const double across =
        spacing_km > 0 ? std::sin(angle(set, a, b) / 2) / std::sin(spacing_km / 6371.0 / 2) : 0;  // by straight lines
    const double apart = spacing_s > 0 ? seconds / spacing_s : 0;
    if (is_ellipsoid) return across * across + apart * apart < 1;
    return (spacing_km <= 0 || angle(set, a, b) * 6371.0 < spacing_km) && apart < 1;
  }

  Retained in_order(const ObservationSet& set, const std::vector<std::uint32_t>& order) const {
    Retained retained;
    for (const std::uint32_t i : order)
      if (std::none_of(retained.begin(), retained.end(), [&](std::uint32_t r) { return excludes(set, r, i); }))
        retained.push_back(i);
    std::sort(retained.begin(), retained.end());
    return retained;
  }
};

const Volume kVolumes[] = {{300, 0, false},  {300, 0, true},  {0, 20, false},    {-1, 20, true},
                           {400, 30, false}, {400, 30, true}, {15000, 0, false}, {0.5, 0, false}};

TEST(PoissonDisk, RetainsInOrderWhatNothingExcludes) {
  for (const test::Region region : {test::Region{-90, 90, -180, 180}, test::Region{85, 90, 0, 360}}) {
    ObservationSet set = test::random_observations(700, 1, 1, region);
    std::vector<std::uint32_t> order(set.size()), by_rank;
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      order[i] = i;
      set.variables["rank"].push_back(static_cast<double>(i % 3));
    }
    by_rank = order;
    std::stable_sort(by_rank.begin(), by_rank.end(), [](auto a, auto b) { return a % 3 > b % 3; });
    for (const Volume& volume : kVolumes) {
      Options options = volume.options();
      options.emplace_back("shuffle", false);
      EXPECT_EQ(test::retained(test::thinner("poisson_disk", options), set), volume.in_order(set, order));
      options.emplace_back("priority_variable", std::string("rank"));
      EXPECT_EQ(test::retained(test::thinner("poisson_disk", options), set), volume.in_order(set, by_rank));
    }
  }
}

TEST(PoissonDisk, RetainsAsManyAsFitInAnyOrder) {
  const ObservationSet set = test::random_observations(800, 1, 2, {-40, 40, 100, 260});
  for (const Volume& volume : kVolumes) {
    const Retained retained = test::retained(test::thinner("poisson_disk", volume.options()), set);
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      const bool is_retained = std::binary_search(retained.begin(), retained.end(), i);
      const bool is_excluded = std::any_of(retained.begin(), retained.end(),
                                           [&](std::uint32_t r) { return r != i && volume.excludes(set, r, i); });
      EXPECT_NE(is_retained, is_excluded);
    }
  }
}

TEST(PoissonDisk, IsRandomBySeed) {
  const ObservationSet set = test::random_observations(800, 1, 3);
  const auto by_seed = [&](std::int64_t seed) {
    return test::retained(test::thinner("poisson_disk", {{"random_seed", seed}}), set);
  };
  EXPECT_EQ(by_seed(1), by_seed(1));
  EXPECT_NE(by_seed(1), by_seed(2));
  EXPECT_EQ(by_seed(1), test::retained(test::thinner("poisson_disk", {}), set));
}

TEST(PoissonDisk, RetainsAllWhereNothingCounts) {
  const ObservationSet set = test::random_observations(50, 1, 4);
  EXPECT_EQ(test::retained(test::thinner("poisson_disk", {{"min_horizontal_spacing", 0.0}}), set).size(), 50U);
}

TEST(PoissonDisk, PlaceCountsWithoutAnySpacingOrWithItsOwn) {
  const ObservationSet set = test::random_observations(300, 1, 5);  // a minute
  const auto with = [&](const Options& options) { return test::retained(test::thinner("poisson_disk", options), set); };
  EXPECT_EQ(with({}), with({{"min_horizontal_spacing", 100.0}}));
  EXPECT_EQ(with({{"min_time_spacing", std::string("PT10S")}}),
            with({{"min_time_spacing", std::string("PT10S")}, {"min_horizontal_spacing", 0.0}}));
  EXPECT_LE(with({{"min_time_spacing", std::string("PT10S")}}).size(), 6U);
}

TEST(PoissonDisk, RefusesWhatIsNoDuration) {
  for (const char* wrong : {"1 hour", "PT0S"}) {
    const auto conflict = test::thinner("poisson_disk", {{"min_time_spacing", std::string(wrong)}}).conflict();
    ASSERT_TRUE(conflict);
    EXPECT_EQ(conflict->key, "min_time_spacing");
  }
}

}  // namespace
}  // namespace thin
