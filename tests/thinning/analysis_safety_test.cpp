#include "libthin/thinning/analysis_safety.h"

#include <gtest/gtest.h>

#include <functional>

namespace thin {
namespace {

const AnalysisCircumstances kSafe = {.variogram = Variogram{0.2, 0.8, 300},
                                     .correlation_length_km = 250,
                                     .length_is_given = true,
                                     .error_ratio = 0.5,
                                     .ratio_is_given = true,
                                     .retained_per_square_length = 1,
                                     .gross_error_share = 0.01};

std::vector<std::string> warnings_with(const std::function<void(AnalysisCircumstances&)>& change) {
  AnalysisCircumstances circumstances = kSafe;
  change(circumstances);
  return analysis_warnings(circumstances);
}

TEST(AnalysisSafety, IsSilentWhereAllIsWell) {
  EXPECT_TRUE(analysis_warnings(kSafe).empty());
  // What comes from the variogram itself can't differ from it.
  EXPECT_TRUE(warnings_with([](auto& c) { c.correlation_length_km = 900, c.length_is_given = false; }).empty());
  EXPECT_TRUE(warnings_with([](auto& c) { c.error_ratio = 3, c.ratio_is_given = false; }).empty());
}

TEST(AnalysisSafety, WarnsOfEachDanger) {
  const std::vector<std::pair<const char*, std::function<void(AnalysisCircumstances&)>>> dangers = {
      {"correlation_length_km = 100", [](auto& c) { c.correlation_length_km = 100; }},
      {"correlation_length_km = 700", [](auto& c) { c.correlation_length_km = 700; }},
      {"error_ratio = 1.5", [](auto& c) { c.error_ratio = 1.5; }},
      {"retain more", [](auto& c) { c.retained_per_square_length = 0.01; }},
      {"fewer tell as much", [](auto& c) { c.retained_per_square_length = 20; }},
      {"contradicted", [](auto& c) { c.gross_error_share = 0.2; }},
      {"innovations", [](auto& c) { c.values_are_innovations = false; }},
      {"no correlation length", [](auto& c) { c.variogram.reset(), c.length_is_given = false; }}};
  for (const auto& [words, change] : dangers) {
    const auto warnings = warnings_with(change);
    ASSERT_EQ(warnings.size(), 1U) << words;
    EXPECT_NE(warnings.front().find(words), std::string::npos) << warnings.front();
  }
}

}  // namespace
}  // namespace thin
