#include "libthin/estimation/bandwidth.h"

#include <gtest/gtest.h>

#include "tests/support/estimation_oracle.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(FilterMisfit, IsThatOfTheDefinition) {
  const ObservationSet set = test::random_observations(200, 2, 1);
  const test::EstimationOracle oracle{{}, set.position_km, set.values, 2, 90};
  for (const bool leave_one_out : {false, true}) {
    std::vector<double> expected(2, 0.0);
    for (std::size_t p = 0; p < set.size(); ++p) {
      std::vector<bool> used(set.size(), true);
      used[p] = !leave_one_out;
      const std::vector<double> estimate = oracle.estimate(set.position_km[p], used);
      for (std::size_t c = 0; c < 2; ++c) {
        const double misfit = std::abs(estimate[c] - set.values_of(p)[c]);
        expected[c] += (leave_one_out ? misfit * misfit : misfit) / static_cast<double>(set.size());
      }
    }
    const std::vector<double> misfit = filter_misfit(places_of(set), set.values, 2, 90, leave_one_out);
    EXPECT_NEAR(misfit[0], expected[0], 1e-12);
    EXPECT_NEAR(misfit[1], expected[1], 1e-12);
  }
}

TEST(CrossValidation, FindsTheBestOfManyBandwidths) {
  const ObservationSet set = test::random_observations(1500, 1, 2);
  const Places places = places_of(set);
  const auto misfit = [&](double h) { return filter_misfit(places, set.values, 1, h, true)[0]; };
  const auto bandwidth_km = cross_validated_bandwidth_km(places, set.values, 1);
  ASSERT_TRUE(bandwidth_km);
  for (double h = 5; h < 500; h *= 1.1) EXPECT_LE(misfit(*bandwidth_km), 1.001 * misfit(h)) << h;
}

TEST(ErrorBound, IsMetByTheBandwidthAndByNoLargerOne) {
  const ObservationSet set = test::random_observations(1500, 2, 3);
  const Places places = places_of(set);
  const std::vector<double> bounds_k = {1.5, 2.5};
  const auto bandwidth_km = error_bound_bandwidth_km(places, set.values, 2, bounds_k);
  ASSERT_TRUE(bandwidth_km);
  const std::vector<double> met = filter_misfit(places, set.values, 2, *bandwidth_km, false);
  EXPECT_LE(met[0], 0.05 * 1.5);
  EXPECT_LE(met[1], 0.05 * 2.5);
  const std::vector<double> missed = filter_misfit(places, set.values, 2, *bandwidth_km * 1.05, false);
  EXPECT_TRUE(missed[0] > 0.05 * 1.5 || missed[1] > 0.05 * 2.5);
}

TEST(ErrorBound, OfNoiseIsAboutTheSpacing) {
  // The trap in the thesis's rule: what the filter takes off is mostly noise.
  const ObservationSet set = test::random_observations(2000, 1, 4);
  const Places places = places_of(set);
  const double bound_k[] = {1.0};
  EXPECT_LT(*error_bound_bandwidth_km(places, set.values, 1, bound_k),
            0.5 * *cross_validated_bandwidth_km(places, set.values, 1));
}

TEST(Bandwidth, SaysWhatIsWrong) {
  BandwidthOptions options;
  options.rule = BandwidthOptions::Rule::error_bound;
  EXPECT_EQ(options.conflict()->key, "error_bounds");
  options.error_bounds_k = {1, 2};
  EXPECT_FALSE(options.conflict());
  const ObservationSet set = test::random_observations(50, 1, 5);
  const auto wrong_number = options.choose(places_of(set), set.values, 1);
  ASSERT_FALSE(wrong_number);
  EXPECT_NE(wrong_number.error().message.find("2 numbers, but 1 channels"), std::string::npos);
  options.error_bounds_k = {1e-9};
  ASSERT_FALSE(options.choose(places_of(test::random_observations(500, 1, 5, {0, 0.01, 0, 0.01})),
                              test::random_observations(500, 1, 5).values, 1));
}

TEST(Bandwidth, OfNothingIsTheDefault) {
  BandwidthOptions options;
  options.rule = BandwidthOptions::Rule::cross_validation;
  EXPECT_EQ(*options.choose(places_at({}), {}, 1), kDefaultBandwidthKm);
}

}  // namespace
}  // namespace thin
