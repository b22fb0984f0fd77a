#include "libthin/analysis/gaussian_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

TEST(GaussianField, HasTheCovarianceThatItSays) {
  const Vector3 origin = geocentric_km(50, 10);
  const Vector3 places[] = {origin, geocentric_km(51, 10), geocentric_km(50, 14), geocentric_km(43, 10)};
  constexpr int seeds = 4000;
  double covariance[4] = {}, mean = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const GaussianField field(seed, 250, 32);
    mean += field.at(origin) / seeds;
    for (int i = 0; i < 4; ++i) covariance[i] += field.at(origin) * field.at(places[i]) / seeds;
  }
  EXPECT_NEAR(mean, 0, 0.06);
  for (int i = 0; i < 4; ++i) {
    const double d = chord_km(origin, places[i]);
    EXPECT_NEAR(covariance[i], std::exp(-d * d / (2 * 250 * 250)), 0.08) << d << " km";
  }
}

TEST(GaussianField, ManyPlacesAreAsOneByOne) {
  const GaussianField field(3, 400);
  const std::vector<Vector3> places = {geocentric_km(1, 2), geocentric_km(-60, 200)};
  EXPECT_EQ(field.at(places), (std::vector<double>{field.at(places[0]), field.at(places[1])}));
  EXPECT_NE(field.at(places[0]), GaussianField(4, 400).at(places[0]));
}

TEST(NormalNumbers, AreNormal) {
  const auto numbers = normal_numbers(40'001, 9);
  ASSERT_EQ(numbers.size(), 40'001U);
  double mean = 0, square = 0, fourth = 0;
  for (const double x : numbers) mean += x / 40'001, square += x * x / 40'001, fourth += x * x * x * x / 40'001;
  EXPECT_NEAR(mean, 0, 0.025);
  EXPECT_NEAR(square, 1, 0.035);
  EXPECT_NEAR(fourth, 3, 0.25);
}

}  // namespace
}  // namespace thin
