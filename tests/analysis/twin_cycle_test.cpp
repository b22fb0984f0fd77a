#include "libthin/analysis/twin_cycle.h"

#include <gtest/gtest.h>

#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

std::vector<Variant> one_variant(const std::string& method) {
  std::vector<Variant> variants(1);
  variants[0].label = method;
  variants[0].thinner = std::make_unique<Thinner>(*find_thinning_method(method));
  variants[0].thinner->declare_options(variants[0].options);
  return variants;
}

TwinCycleOptions small_cycle() {
  TwinCycleOptions options;
  options.cycles = 6;
  options.spin_up_cycles = 2;
  options.grid_deg = 6;
  options.count = 150;
  options.observation_step = 6;
  options.forecast_days = 2;
  options.forecast_every = 2;
  return options;
}

TwinCycles cycled(const std::vector<Variant>& variants) {
  auto cycles = twin_cycles(variants, {}, small_cycle(), 1, [](const std::string&) {});
  EXPECT_TRUE(cycles) << (cycles ? "" : cycles.error().message);
  return cycles ? *cycles : TwinCycles{};
}

TEST(TwinCycles, ObservationsBringTheForecastNearerToTheTruth) {
  const TwinCycles cycles = cycled(one_variant("eea"));
  ASSERT_EQ(cycles.sets.size(), 5U);
  const CycledSet &none = cycles.sets[0], &all = cycles.sets[1], &eea = cycles.sets[4];
  EXPECT_EQ(none.label, "none");
  EXPECT_EQ(none.analysis_error_k, none.background_error_k);
  ASSERT_EQ(all.analysis_error_k.size(), 4U);
  for (const CycledSet* set : {&all, &eea}) {
    EXPECT_LT(set->analysis_error_k.back(), 0.8 * none.analysis_error_k.back());
    ASSERT_EQ(set->global.size(), 3U);
    ASSERT_EQ(set->global[0].size(), 2U);
    EXPECT_GT(set->global[0].back(), none.global[0].back());
    EXPECT_GT(set->global[2].back(), none.global[2].back());
    for (const auto& lead : set->northern)
      for (const double correlation : lead) EXPECT_LE(correlation, 1);
  }
  EXPECT_EQ(eea.retained, std::vector<double>(4, 150));
}

TEST(TwinCycles, SameBitsForAnyNumberOfThreads) {
  const auto variants = one_variant("top_down_eea");
  const auto errors = [&](int threads) {
    const ThreadLimit limit(threads);
    return cycled(variants).sets.back().analysis_error_k;
  };
  EXPECT_EQ(errors(1), errors(2));
}

}  // namespace
}  // namespace thin
