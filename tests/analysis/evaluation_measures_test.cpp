// Each measure against its slow definition.

#include <gtest/gtest.h>

#include <numeric>

#include "libthin/analysis/common_error.h"
#include "libthin/analysis/count_fitting.h"
#include "libthin/analysis/density_difference.h"
#include "libthin/analysis/separation_statistics.h"
#include "libthin/analysis/signal_free.h"
#include "libthin/analysis/synthetic_innovations.h"
#include "libthin/estimation/gme_grid.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/analysis_oracle.h"
#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"
#include "tests/support/thinning.h"

namespace thin {
namespace {

Retained every(std::size_t step, std::size_t n) {
  Retained retained;
  for (std::size_t i = 0; i < n; i += step) retained.push_back(static_cast<std::uint32_t>(i));
  return retained;
}

TEST(SeparationStatistics, EqualsAllPairs) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    const ObservationSet set = test::random_observations(300, 1, seed);
    const Retained retained = every(2, set.size());
    const std::vector<double> distances_km = test::nearest_distances_km(set, retained);
    const SeparationStatistics statistics = separation_statistics(set, retained);
    const std::size_t n = distances_km.size();  // 150
    EXPECT_NEAR(statistics.minimum_km, distances_km[0], 1e-9);
    EXPECT_NEAR(statistics.mean_km, test::mean(distances_km), 1e-9);
    EXPECT_NEAR(statistics.percentile_5_km, distances_km[7], 1e-9);  // 7.5 of 150: the eighth
    EXPECT_NEAR(statistics.percentile_25_km, distances_km[37], 1e-9);
    EXPECT_NEAR(statistics.median_km, distances_km[n / 2 - 1], 1e-9);
    EXPECT_NEAR(statistics.percentile_75_km, distances_km[112], 1e-9);
    EXPECT_NEAR(statistics.percentile_95_km, distances_km[142], 1e-9);
  }
}

TEST(SeparationStatistics, OfFewAndOfEqualPlaces) {
  ObservationSet set = test::random_observations(3, 1, 1);
  EXPECT_EQ(separation_statistics(set, Retained{}).mean_km, 0);
  EXPECT_EQ(separation_statistics(set, Retained{1}).mean_km, 0);
  set.position_km[1] = set.position_km[0];
  EXPECT_EQ(separation_statistics(set, Retained{0, 1}).mean_km, 0);
}

TEST(CommonError, EqualsTheDefinitionWhateverTheSlice) {
  const ObservationSet set = test::random_observations(120, 2, 4);
  const std::vector<Retained> sets = {every(3, set.size()), every(10, set.size()), {}};
  test::EstimationOracle oracle{.evaluation_points = set.position_km,
                                .positions = set.position_km,
                                .values = set.values,
                                .channels = 2,
                                .bandwidth_km = 150};
  for (const std::size_t slice : {std::size_t{50}, std::size_t{1} << 17}) {
    SCOPED_TRACE(slice);
    const auto errors = common_errors(set, sets, {.bandwidth_km = 150, .level = 4, .slice = slice});
    ASSERT_TRUE(errors);
    for (std::size_t i = 0; i < sets.size(); ++i) {
      std::vector<bool> retained(set.size(), false);
      for (const std::uint32_t p : sets[i]) retained[p] = true;
      for (const bool grid : {false, true}) {
        oracle.evaluation_points = grid ? gme_grid(4) : set.position_km;
        const EstimationError& error = grid ? (*errors)[i].on_grid : (*errors)[i].at_observations;
        const double sum = oracle.error_sum(retained);
        EXPECT_NEAR(error.mean_squared_k2 * static_cast<double>(error.evaluation_point_count), sum, 1e-9 * (1 + sum));
        EXPECT_NEAR(error.per_channel_k2[0] + error.per_channel_k2[1], error.mean_squared_k2, 1e-12);
      }
    }
    const EstimationError& of_none = errors->back().on_grid;
    EXPECT_NEAR(of_none.mean_squared_k2, of_none.empty_mean_squared_k2, 1e-12);
  }
}

TEST(CommonError, SignalToNoiseInDecibels) {
  ObservationSet set = test::random_observations(2, 2, 1);
  set.values = {3, 4, 0, 1};  // |f| = 5 and 1
  EXPECT_DOUBLE_EQ(mean_absolute_value_k(set), 3);
  EXPECT_NEAR(signal_to_noise_db(3, 0.09), 20, 1e-12);
  EXPECT_EQ(signal_to_noise_db(3, 0), std::numeric_limits<double>::infinity());
}

TEST(DensityDifference, CountsPerBox) {
  const ObservationSet set = test::random_observations(2000, 1, 5);
  const Retained some = every(3, set.size()), others = every(4, set.size());
  const auto boxes = density_difference(set, some, others, 300);
  int observations = 0, retained = 0, reference = 0, sum = 0;
  for (const BoxDifference& box : boxes) {
    EXPECT_GT(box.observations, 0);
    observations += box.observations, retained += box.retained, reference += box.reference;
    sum += std::abs(box.retained - box.reference);
    // Counted anew: nearer to the centre than half a diagonal are all of the box, and no more than those of nine boxes.
    const Vector3 centre = geocentric_km(box.latitude_deg, box.longitude_deg);
    int near = 0;
    for (std::size_t i = 0; i < set.size(); ++i) near += chord_km(set.position_km[i], centre) < 0.75 * 300;
    EXPECT_GE(near, box.observations);
  }
  EXPECT_EQ(observations, 2000);
  EXPECT_EQ(retained, static_cast<int>(some.size()));
  EXPECT_EQ(reference, static_cast<int>(others.size()));
  EXPECT_DOUBLE_EQ(mean_absolute_difference(boxes), sum / static_cast<double>(boxes.size()));
}

TEST(SignalFree, EqualsAllPairs) {
  for (const unsigned seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const ObservationSet set = test::random_observations(250, 2, seed);
    const auto flags = signal_free(set, {.bandwidth_km = 150, .noise_factor = 20});
    ASSERT_TRUE(flags);
    const std::vector<double> beyond = test::beyond_noise(set, 150, 20);
    std::size_t free = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (std::abs(beyond[i]) < 1e-6) continue;  // of rounding
      EXPECT_EQ((*flags)[i] != 0, beyond[i] < 0) << i;
      free += (*flags)[i];
    }
    EXPECT_GT(free, 0U);
    EXPECT_LT(free, set.size());
  }
}

TEST(SignalFree, FindsWhatTheAtmosphereDoesNotHave) {
  const ObservationSet set = orbit_innovations(9000);
  const auto flags = signal_free(set, {});
  ASSERT_TRUE(flags);
  const std::vector<double>& truth = set.variables.at(kSignalFree);
  std::size_t right = 0;
  for (std::size_t i = 0; i < set.size(); ++i) right += ((*flags)[i] != 0) == (truth[i] != 0);
  EXPECT_GT(right, set.size() * 85 / 100);
}

TEST(SignalFree, WithoutNoiseIsWhereNothingVaries) {
  const ObservationSet set = gradient_innovations(2000);
  const auto flags = signal_free(set, {.bandwidth_km = 30});
  ASSERT_TRUE(flags);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double east_km = set.longitude_deg[i] * 111.2;
    const bool varies = std::abs(east_km)<90, is_flat = std::abs(east_km)> 290;  // 100 + 2 x 3h + a little
    if (!varies && !is_flat) continue;
    EXPECT_EQ((*flags)[i] != 0, is_flat) << east_km;
  }
}

TEST(CountFitting, ComesNearestByItsOption) {
  const ObservationSet set = test::random_observations(1500, 1, 6);
  for (const std::size_t count : {40U, 200U, 700U}) {
    SCOPED_TRACE(count);
    Thinner box = test::thinner("box", {});
    OptionTable options;
    box.declare_options(options);
    EXPECT_EQ(density_option(options), "horizontal_mesh");
    const auto value = fit_to_count(box, options, "horizontal_mesh", set, count);
    ASSERT_TRUE(value);
    const std::size_t retained = test::retained(box, set).size();  // with the option as it was left
    EXPECT_NEAR(static_cast<double>(retained), static_cast<double>(count), 0.1 * static_cast<double>(count));
  }
}

TEST(CountFitting, FindsTheBestOfAllSteps) {
  const ObservationSet set = test::random_observations(3000, 1, 6);
  Thinner stepwise = test::thinner("stepwise", {});
  OptionTable options;
  stepwise.declare_options(options);
  for (const std::size_t count : {3000U, 340U, 100U, 1U}) {
    SCOPED_TRACE(count);
    ASSERT_TRUE(fit_to_count(stepwise, options, "step", set, count));
    const auto miss = [&] {
      const auto retained = static_cast<double>(test::retained(stepwise, set).size());
      return std::abs(retained - static_cast<double>(count));
    };
    const double fitted = miss();
    for (std::int64_t step = 1; step <= 30; ++step) {
      ASSERT_FALSE(options.find("step")->assign(step));
      EXPECT_GE(miss(), fitted) << step;
    }
  }
}

TEST(CountFitting, RefusesWhatIsNoNumber) {
  const ObservationSet set = test::random_observations(10, 1, 6);
  Thinner box = test::thinner("box", {});
  OptionTable options;
  box.declare_options(options);
  const auto value = fit_to_count(box, options, "category_variable", set, 5);
  ASSERT_FALSE(value);
  EXPECT_EQ(value.error().kind, ErrorKind::configuration);
}

}  // namespace
}  // namespace thin
