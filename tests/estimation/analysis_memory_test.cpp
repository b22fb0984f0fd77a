#include "libthin/estimation/analysis_memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/estimation/analysis_target.h"
#include "tests/support/random_observations.h"

namespace thin {
namespace {

TEST(AnalysisMemory, RefusesWhatWouldNotFitWithTheRemedy) {
  const Places places = places_of(test::random_observations(3000, 1, 1));
  const std::vector<std::uint32_t> points = spread_places(places, 100);
  const BackgroundCovariance covariance{200, false};
  EXPECT_TRUE(expect_analysis_to_fit(places, points, covariance, 300, std::uint64_t{1} << 30));
  const Result<void> fits = expect_analysis_to_fit(places, points, covariance, 300, 1 << 20);
  ASSERT_FALSE(fits);
  EXPECT_EQ(fits.error().kind, ErrorKind::configuration);
  EXPECT_NE(fits.error().message.find("larger evaluation_spacing_km"), std::string::npos) << fits.error().message;
  EXPECT_TRUE(expect_analysis_to_fit({}, {}, covariance, 0, 1));
}

TEST(AnalysisMemory, CountsWhatIsWithinReach) {
  const ObservationSet set = test::random_observations(400, 1, 2);
  const Places places = places_of(set);
  const std::vector<std::uint32_t> points = {5, 100, 399};
  double pairs = 0;
  for (const std::uint32_t q : points)
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Vector3 &a = set.position_km[q], &b = set.position_km[i];
      pairs += std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) <= 600;
    }
  EXPECT_NEAR(observations_within_reach(places, points, {200, false}), pairs / 3, 1e-9);
}

}  // namespace
}  // namespace thin
