#include "libthin/analysis/transport_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

// A hill near 40 degrees north, turned about the poles by an angle.
double hill(const Vector3& d, double turned_rad) {
  const double latitude = 0.7, x = std::cos(latitude) * std::cos(turned_rad),
               y = std::cos(latitude) * std::sin(turned_rad);
  const double squared = 2 - 2 * (x * d.x + y * d.y + std::sin(latitude) * d.z);
  return std::exp(-squared / (2 * 0.25 * 0.25));
}

Wind turning(double rad_per_h) {
  Wind wind;
  wind.solid_rad_per_h = rad_per_h;
  return wind;
}

double mean(const GlobalGrid& grid, const std::vector<double>& field) {
  double sum = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) sum += grid.area(i) * field[i];
  return sum;
}

// Root mean square error after ten days of solid rotation.
double rotation_error(double step_deg, double step_h) {
  const GlobalGrid grid(step_deg);
  const double rate = 2 * std::numbers::pi / (12 * 24);
  std::vector<std::vector<double>> fields(1);
  for (const Vector3& d : grid.directions()) fields[0].push_back(hill(d, 0));
  const int steps = static_cast<int>(std::lround(240 / step_h));
  for (int step = 0; step < steps; ++step) advance(grid, turning(rate), {}, fields, step * step_h, step_h);
  double sum = 0;
  for (std::size_t i = 0; i < grid.size(); ++i)
    sum += grid.area(i) * std::pow(fields[0][i] - hill(grid.directions()[i], rate * 240), 2);
  return std::sqrt(sum);
}

TEST(TransportModel, SolidRotationConverges) {
  const double coarse = rotation_error(6, 6), middle = rotation_error(3, 3), fine = rotation_error(1.5, 1.5);
  EXPECT_LT(fine, 0.005);
  EXPECT_LT(middle, coarse / 4) << coarse;  // at least of second order
  EXPECT_LT(fine, middle / 4) << middle;
}

TEST(TransportModel, AConstantStaysAndTheAreasSumToOne) {
  const GlobalGrid grid(5);
  std::vector<std::vector<double>> fields = {std::vector<double>(grid.size(), 3.5)};
  for (int step = 0; step < 20; ++step) advance(grid, Wind::random(4), {}, fields, 2 * step, 2);
  for (const double value : fields[0]) EXPECT_NEAR(value, 3.5, 1e-11);
  EXPECT_NEAR(mean(grid, fields[0]), 3.5, 1e-11);
}

// The wind has no divergence: the mean over the Earth changes by errors of the scheme alone.
TEST(TransportModel, TheMeanIsKept) {
  const GlobalGrid grid(2);
  const Wind wind = Wind::random(7);
  std::vector<std::vector<double>> fields(1);
  for (const Vector3& d : grid.directions()) fields[0].push_back(hill(d, 1) + 2 * d.z * d.z);
  const double before = mean(grid, fields[0]);
  const auto [low, high] = std::minmax_element(fields[0].begin(), fields[0].end());
  const double least = *low, most = *high;
  for (int step = 0; step < 84; ++step) advance(grid, wind, {}, fields, 2 * step, 2);  // a week
  EXPECT_NEAR(mean(grid, fields[0]), before, 0.01 * before);
  EXPECT_GT(*std::min_element(fields[0].begin(), fields[0].end()), least - 0.1 * (most - least));
  EXPECT_LT(*std::max_element(fields[0].begin(), fields[0].end()), most + 0.1 * (most - least));
}

TEST(TransportModel, WindIsTangentialAndFreeOfDivergence) {
  const Wind wind = Wind::random(2).with_errors(0.4, 3);
  const GlobalGrid grid(15);
  for (const Vector3& d : grid.directions()) {
    const Vector3 v = wind.at(30).velocity(d);
    EXPECT_NEAR(v.x * d.x + v.y * d.y + v.z * d.z, 0, 1e-12);
    EXPECT_LT(std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) * kEarthRadiusKm / 3.6, 160);  // m/s
    // Of v(x) continued along the radius: the divergence in space is that on the sphere.
    constexpr double h = 1e-5;
    const auto at = [&](double x, double y, double z) { return wind.at(30).velocity({d.x + x, d.y + y, d.z + z}); };
    const double divergence =
        (at(h, 0, 0).x - at(-h, 0, 0).x + at(0, h, 0).y - at(0, -h, 0).y + at(0, 0, h).z - at(0, 0, -h).z) / (2 * h);
    EXPECT_NEAR(divergence, 0, 1e-6);
  }
}

TEST(TransportModel, ErrorsOfTheWindGrowWithTheirSize) {
  const Wind wind = Wind::random(5);
  const GlobalGrid grid(10);
  const auto difference = [&](double size) {
    const Wind other = wind.with_errors(size, 6);
    double sum = 0;
    for (const Vector3& d : grid.directions()) {
      const Vector3 a = wind.at(50).velocity(d), b = other.at(50).velocity(d);
      sum += std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2) + std::pow(a.z - b.z, 2);
    }
    return std::sqrt(sum);
  };
  EXPECT_EQ(difference(0), 0);
  EXPECT_GT(difference(0.2), 1.5 * difference(0.1));
}

TEST(TransportModel, RelaxesTowardsTheEquilibrium) {
  const GlobalGrid grid(10);
  std::vector<std::vector<double>> fields(2, std::vector<double>(grid.size(), 0));
  const Relaxation relaxation{std::vector<double>(2 * grid.size(), 1), 48};
  for (int step = 0; step < 24; ++step) advance(grid, turning(0.02), relaxation, fields, 2 * step, 2);
  for (const auto& field : fields)
    for (const double value : field) EXPECT_NEAR(value, 1 - std::exp(-1), 1e-9);
}

TEST(GlobalGrid, SamplesSmoothFieldsAcrossThePoles) {
  const GlobalGrid grid(2);
  const auto smooth = [](const Vector3& d) { return d.x * d.x + 0.5 * d.y - d.z * d.x; };
  std::vector<double> field;
  for (const Vector3& d : grid.directions()) field.push_back(smooth(d));
  const std::vector<Vector3> places = {geocentric_km(89.9, 33), geocentric_km(-89.5, 181), geocentric_km(12.3, 359.9),
                                       geocentric_km(-45, -0.4)};
  const auto values = grid.sample(field, places);
  const double degree = std::numbers::pi / 180;
  const double at[][2] = {{89.9, 33}, {-89.5, 181}, {12.3, 359.9}, {-45, -0.4}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double latitude = at[i][0] * degree, longitude = at[i][1] * degree;
    const Vector3 d = {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                       std::sin(latitude)};
    EXPECT_NEAR(values[i], smooth(d), 1e-5);
  }
}

TEST(TransportModel, SameBitsForAnyNumberOfThreads) {
  const GlobalGrid grid(5);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    std::vector<std::vector<double>> fields(1);
    for (const Vector3& d : grid.directions()) fields[0].push_back(hill(d, 0.3));
    for (int step = 0; step < 5; ++step) advance(grid, Wind::random(1), {}, fields, 2 * step, 2);
    return fields;
  };
  EXPECT_EQ(run(1), run(2));
}

}  // namespace
}  // namespace thin
