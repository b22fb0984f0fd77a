#include "libthin/analysis/transport_model.h"

#include <cmath>
#include <numbers>
#include <random>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vector3 direction_of(double latitude_rad, double longitude_rad) {
  return {std::cos(latitude_rad) * std::cos(longitude_rad), std::cos(latitude_rad) * std::sin(longitude_rad),
          std::sin(latitude_rad)};
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vector3 normalised(const Vector3& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}

Vector3 moved(const Vector3& from, const Vector3& velocity, double hours) {
  return normalised({from.x + hours * velocity.x, from.y + hours * velocity.y, from.z + hours * velocity.z});
}

// Cubic Lagrange weights for the points -1, 0, 1, 2 at x in 0..1.
void cubic_weights(double x, double (&weights)[4]) {
  weights[0] = -x * (x - 1) * (x - 2) / 6;
  weights[1] = (x + 1) * (x - 1) * (x - 2) / 2;
  weights[2] = -(x + 1) * x * (x - 2) / 2;
  weights[3] = (x + 1) * x * (x - 1) / 6;
}

struct Random {
  std::mt19937_64 engine;
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1.0p-53;
  }
};

}  // namespace

GlobalGrid::GlobalGrid(double step_deg)
    : rows_(static_cast<std::size_t>(std::lround(180 / step_deg))), columns_(2 * rows_), step_rad_(step_deg * kDegree) {
  for (std::size_t row = 0; row < rows_; ++row)
    for (std::size_t column = 0; column < columns_; ++column)
      directions_.push_back(direction_of((static_cast<double>(row) + 0.5) * step_rad_ - std::numbers::pi / 2,
                                         static_cast<double>(column) * step_rad_));
}

std::vector<Vector3> GlobalGrid::positions_km() const {
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < size(); ++i)
    positions.push_back(geocentric_km(latitude_deg(i), static_cast<double>(i % columns_) * step_rad_ / kDegree));
  return positions;
}

double GlobalGrid::latitude_deg(std::size_t point) const {
  return (static_cast<double>(point / columns_) + 0.5) * step_rad_ / kDegree - 90;
}

double GlobalGrid::area(std::size_t point) const {
  const double south = static_cast<double>(point / columns_) * step_rad_ - std::numbers::pi / 2;
  return (std::sin(south + step_rad_) - std::sin(south)) / (2 * static_cast<double>(columns_));
}

GlobalGrid::Stencil GlobalGrid::stencil(const Vector3& d) const {
  const double latitude = std::atan2(d.z, std::hypot(d.x, d.y)), longitude = std::atan2(d.y, d.x);
  const double row = (latitude + std::numbers::pi / 2) / step_rad_ - 0.5;
  const double column = (longitude < 0 ? longitude + 2 * std::numbers::pi : longitude) / step_rad_;
  const auto first_row = static_cast<std::ptrdiff_t>(std::floor(row)) - 1;
  const auto first_column = static_cast<std::ptrdiff_t>(std::floor(column)) - 1;
  double across[4], along[4];
  cubic_weights(row - std::floor(row), across);
  cubic_weights(column - std::floor(column), along);
  const auto rows = static_cast<std::ptrdiff_t>(rows_), columns = static_cast<std::ptrdiff_t>(columns_);
  Stencil stencil;
  for (std::ptrdiff_t j = 0; j < 4; ++j) {
    std::ptrdiff_t r = first_row + j, shift = 0;
    if (r < 0) r = -1 - r, shift = columns / 2;
    if (r >= rows) r = 2 * rows - 1 - r, shift = columns / 2;
    for (std::ptrdiff_t i = 0; i < 4; ++i) {
      const std::ptrdiff_t c = (first_column + i + shift + 2 * columns) % columns;
      stencil.points[4 * j + i] = static_cast<std::uint32_t>(r * columns + c);
      stencil.weights[4 * j + i] = across[j] * along[i];
    }
  }
  return stencil;
}

std::vector<double> GlobalGrid::sample(std::span<const double> field, std::span<const Vector3> positions_km) const {
  std::vector<double> values;
  values.reserve(positions_km.size());
  for (const Vector3& position : positions_km) {
    // The grid's rows are at geodetic latitudes.
    const GeodeticPosition place = geodetic(position);
    const Stencil around = stencil(direction_of(place.latitude_deg * kDegree, place.longitude_deg * kDegree));
    double sum = 0;
    for (int k = 0; k < 16; ++k) sum += around.weights[k] * field[around.points[k]];
    values.push_back(sum);
  }
  return values;
}

Wind Wind::random(std::uint64_t seed, int vortices) {
  Random random{std::mt19937_64(seed)};
  Wind wind;
  wind.solid_rad_per_h = 2 * std::numbers::pi / (12 * 24);
  for (int i = 0; i < vortices; ++i) {
    Vortex vortex{};
    vortex.latitude_deg = std::asin(random.between(-0.95, 0.95)) / kDegree;
    vortex.longitude_deg = random.between(0, 360);
    vortex.drift_deg_per_h = random.between(0.15, 0.6);
    vortex.radius = random.between(0.1, 0.24);
    const double peak = random.between(0.006, 0.016);  // Earth radii per hour: 11 to 28 m/s, at d = R
    vortex.rate_rad_per_h = (random.between(-1, 1) < 0 ? -1 : 1) * peak / (vortex.radius * std::exp(-0.5));
    wind.vortices.push_back(vortex);
  }
  return wind;
}

Wind Wind::with_errors(double size, std::uint64_t seed) const {
  Random random{std::mt19937_64(seed)};
  Wind wind = *this;
  wind.solid_rad_per_h *= 1 + 0.1 * size * random.between(-1, 1);
  for (Vortex& vortex : wind.vortices) {
    vortex.strength_error = size * random.between(-1.5, 1.5);
    vortex.displacement_deg = size * vortex.radius / kDegree * random.between(-1.5, 1.5) /
                              std::max(std::cos(vortex.latitude_deg * kDegree), 0.3);
    vortex.error_period_h = random.between(72, 144);
    vortex.error_phase_rad = random.between(0, 2 * std::numbers::pi);
  }
  return wind;
}

Wind::Now Wind::at(double time_h) const {
  Now now{solid_rad_per_h, {}};
  for (const Vortex& vortex : vortices) {
    const double swing = std::sin(2 * std::numbers::pi * time_h / vortex.error_period_h + vortex.error_phase_rad);
    const double longitude = vortex.longitude_deg + vortex.drift_deg_per_h * time_h + vortex.displacement_deg * swing;
    now.turns.push_back({direction_of(vortex.latitude_deg * kDegree, longitude * kDegree), vortex.radius,
                         vortex.rate_rad_per_h * (1 + vortex.strength_error * swing)});
  }
  return now;
}

Vector3 Wind::Now::velocity(const Vector3& d) const {
  Vector3 velocity = {-solid_rad_per_h * d.y, solid_rad_per_h * d.x, 0};
  for (const Turn& turn : turns) {
    const double squared = 2 - 2 * (turn.centre.x * d.x + turn.centre.y * d.y + turn.centre.z * d.z);  // chord
    const double decay = squared / (2 * turn.radius * turn.radius);
    if (decay > 12) continue;
    const double rate = turn.rate_rad_per_h * std::exp(-decay);
    const Vector3 along = cross(turn.centre, d);
    velocity.x += rate * along.x, velocity.y += rate * along.y, velocity.z += rate * along.z;
  }
  return velocity;
}

void advance(const GlobalGrid& grid, const Wind& wind, const Relaxation& relaxation,
             std::vector<std::vector<double>>& fields, double time_h, double hours) {
  const std::size_t n = grid.size();
  std::vector<std::vector<double>> next(fields.size(), std::vector<double>(n));
  const std::size_t equilibria = relaxation.equilibrium.size() / n;
  const double gain = relaxation.time_h > 0 ? 1 - std::exp(-hours / relaxation.time_h) : 0;
  const Wind::Now at_end = wind.at(time_h + hours), at_middle = wind.at(time_h + hours / 2);
  parallel_ranges(n, 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3& arrival = grid.directions()[i];
      const Vector3 halfway = moved(arrival, at_end.velocity(arrival), -hours / 2);
      const auto stencil = grid.stencil(moved(arrival, at_middle.velocity(halfway), -hours));
      for (std::size_t f = 0; f < fields.size(); ++f) {
        double sum = 0;
        for (int k = 0; k < 16; ++k) sum += stencil.weights[k] * fields[f][stencil.points[k]];
        if (equilibria > 0) sum += gain * (relaxation.equilibrium[(f % equilibria) * n + i] - sum);
        next[f][i] = sum;
      }
    }
  });
  fields = std::move(next);
}

}  // namespace thin
