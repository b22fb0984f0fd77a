#include "libthin/foundation/principal_axes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_points.h"

namespace thin {
namespace {

// Mean squared deviation of the points along a direction, from its definition.
double variance_along(std::span<const double> points, std::span<const double> centroid,
                      std::span<const double> direction) {
  const std::size_t dimension = direction.size();
  double sum = 0;
  for (std::size_t row = 0; row < points.size(); row += dimension) {
    double along = 0;
    for (std::size_t axis = 0; axis < dimension; ++axis)
      along += (points[row + axis] - centroid[axis]) * direction[axis];
    sum += along * along;
  }
  return points.empty() ? 0 : sum / (static_cast<double>(points.size()) / static_cast<double>(dimension));
}

TEST(PrincipalAxes, AreOrthonormalAndCarryTheVariance) {
  for (const int dimension : {1, 3, 5, 16})
    for (const auto& cloud : test::awkward_clouds(200, dimension, 5)) {
      SCOPED_TRACE(cloud.name + " in " + std::to_string(dimension) + " dimensions");
      const PrincipalAxes result = principal_axes(cloud.coordinates, dimension);
      for (int i = 0; i < dimension; ++i) {
        EXPECT_GE(result.variances[static_cast<std::size_t>(i)], 0);
        if (i > 0) {
          EXPECT_LE(result.variances[static_cast<std::size_t>(i)], result.variances[static_cast<std::size_t>(i - 1)]);
        }
        EXPECT_NEAR(variance_along(cloud.coordinates, result.centroid, result.axis(i)),
                    result.variances[static_cast<std::size_t>(i)], 1e-9);
        for (int j = 0; j <= i; ++j) {
          double product = 0;
          for (int axis = 0; axis < dimension; ++axis) product += result.axis(i)[axis] * result.axis(j)[axis];
          EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12);
        }
      }
    }
}

// No direction has more variance than the first axis: tried against many.
TEST(PrincipalAxes, TheFirstHasTheLargestVarianceOfAllDirections) {
  for (const auto& cloud : test::awkward_clouds(100, 3, 8)) {
    SCOPED_TRACE(cloud.name);
    const PrincipalAxes result = principal_axes(cloud.coordinates, 3);
    for (int i = 0; i < 50; ++i)
      for (int j = 0; j < 50; ++j) {
        const double z = i / 24.5 - 1, turn = j * 0.1256, flat = std::sqrt(1 - z * z);
        const double direction[] = {flat * std::cos(turn), flat * std::sin(turn), z};
        EXPECT_LE(variance_along(cloud.coordinates, result.centroid, direction), result.variances[0] + 1e-9);
      }
  }
}

TEST(PrincipalAxes, PointAlongTheirLargestComponent) {
  for (const auto& cloud : test::awkward_clouds(50, 3, 9)) {
    const PrincipalAxes result = principal_axes(cloud.coordinates, 3);
    for (int i = 0; i < 3; ++i) {
      double largest = 0;
      for (const double component : result.axis(i))
        if (std::abs(component) > std::abs(largest) * (1 + 1e-9)) largest = component;
      EXPECT_GT(largest, 0) << cloud.name;
    }
  }
}

TEST(PrincipalAxes, OfNothingAreTheCoordinateAxes) {
  const PrincipalAxes result = principal_axes({}, 3);
  EXPECT_EQ(result.centroid, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(result.variances, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(result.axes, (std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(PrincipalAxes, WeightsCountLikeRepetitions) {
  const std::vector<double> points = {0, 0, 0, 1, 2, 3, -2, 5, 1};
  const std::vector<double> repeated = {0, 0, 0, 1, 2, 3, 1, 2, 3, 1, 2, 3, -2, 5, 1, -2, 5, 1};
  const PrincipalAxes weighted = principal_axes(points, 3, std::vector<double>{1, 3, 2});
  const PrincipalAxes expected = principal_axes(repeated, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(weighted.centroid[i], expected.centroid[i], 1e-12);
    EXPECT_NEAR(weighted.variances[i], expected.variances[i], 1e-12);
  }
}

}  // namespace
}  // namespace thin
