#include "libthin/analysis/optimal_interpolation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libthin/estimation/places.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

constexpr int kMostIterations = 2000;
const double kHalfWidth = std::sqrt(10.0 / 3);  // in lengths: the curvature at 0 is that of the Gaussian

// Of two n x channels tables, for each channel.
std::vector<double> products(std::span<const double> a, std::span<const double> b, std::size_t channels) {
  std::vector<double> sums(channels, 0);
  for (std::size_t i = 0; i < a.size(); i += channels)
    for (std::size_t c = 0; c < channels; ++c) sums[c] += a[i + c] * b[i + c];
  return sums;
}

}  // namespace

double background_correlation(double distance_km, double length_km) {
  const double r = distance_km / (kHalfWidth * length_km);
  if (r >= 2) return 0;
  const double r2 = r * r, r3 = r2 * r;
  if (r <= 1) return 1 - 5.0 / 3 * r2 + 5.0 / 8 * r3 + r2 * r2 / 2 - r2 * r3 / 4;
  return std::max(4 - 5 * r + 5.0 / 3 * r2 + 5.0 / 8 * r3 - r2 * r2 / 2 + r2 * r3 / 12 - 2 / (3 * r), 0.0);
}

OptimalInterpolation::OptimalInterpolation(std::span<const Vector3> observations_km,
                                           std::span<const Vector3> targets_km, double length_km)
    : among_observations_(rows_between(observations_km, observations_km, length_km)),
      at_targets_(rows_between(targets_km, observations_km, length_km)) {}

OptimalInterpolation::Rows OptimalInterpolation::rows_between(std::span<const Vector3> from,
                                                              std::span<const Vector3> to, double length_km) {
  assert(length_km > 0);
  const Places centres = places_at(from);
  const KdTree tree(places_at(to).coordinates, 3);
  std::vector<std::vector<Neighbour>> found(from.size());
  parallel_ranges(from.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) tree.radius_search(centres.of(i), 2 * kHalfWidth * length_km, found[i]);
  });
  Rows rows;
  rows.begin.push_back(0);
  for (const auto& row : found) rows.begin.push_back(rows.begin.back() + row.size());
  rows.column.resize(rows.begin.back());
  rows.weight.resize(rows.begin.back());
  parallel_ranges(from.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < found[i].size(); ++k) {
        rows.column[rows.begin[i] + k] = found[i][k].index;
        rows.weight[rows.begin[i] + k] =
            static_cast<float>(background_correlation(std::sqrt(found[i][k].distance_squared), length_km));
      }
  });
  return rows;
}

void OptimalInterpolation::multiply(const Rows& rows, std::span<const double> x, std::size_t channels,
                                    std::vector<double>& product) {
  product.assign((rows.begin.size() - 1) * channels, 0);
  // Blocks of a fixed number of channels stay in registers.
  for (std::size_t first = 0; first < channels;) {
    const std::size_t left = channels - first;
    const std::size_t block = left >= 8 ? 8 : left >= 4 ? 4 : left >= 2 ? 2 : 1;
    (block == 8   ? multiply_block<8>
     : block == 4 ? multiply_block<4>
     : block == 2 ? multiply_block<2>
                  : multiply_block<1>)(rows, x.data() + first, channels, product.data() + first);
    first += block;
  }
}

template <std::size_t Block>
void OptimalInterpolation::multiply_block(const Rows& rows, const double* x, std::size_t channels, double* product) {
  parallel_ranges(rows.begin.size() - 1, 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sums[Block] = {};
      for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
        const double weight = rows.weight[k];
        const double* from = x + rows.column[k] * channels;
        for (std::size_t c = 0; c < Block; ++c) sums[c] += weight * from[c];
      }
      for (std::size_t c = 0; c < Block; ++c) product[i * channels + c] = sums[c];
    }
  });
}

// One system (C + s I) x = y of those with the same y. zeta scales the residual of the least one to its own.
struct OptimalInterpolation::Shifted {
  double shift;  // beyond the least error variance
  std::vector<double> solution, direction;
  std::vector<double> zeta, zeta_before;  // of each channel
};

// Conjugate gradients for all channels and ratios at one time: one pass over the matrix serves all.
std::vector<std::vector<double>> OptimalInterpolation::solve(std::span<const double> values, std::size_t channels,
                                                             std::span<const double> error_ratios,
                                                             double tolerance) const {
  const double least = *std::min_element(error_ratios.begin(), error_ratios.end());
  std::vector<Shifted> systems;
  for (const double ratio : error_ratios)
    systems.push_back({ratio * ratio - least * least, std::vector<double>(values.size(), 0),
                       std::vector<double>(values.begin(), values.end()), std::vector<double>(channels, 1),
                       std::vector<double>(channels, 1)});
  std::vector<double> residual(values.begin(), values.end()), direction = residual, image;
  std::vector<double> squared = products(residual, residual, channels), goal = squared;
  for (double& each : goal) each *= tolerance * tolerance;
  std::vector<double> step_before(channels, 1), turn_before(channels, 0);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    bool done = true;
    for (std::size_t c = 0; c < channels; ++c) done = done && squared[c] <= goal[c];
    if (done) break;
    multiply(among_observations_, direction, channels, image);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] += least * least * direction[i];
    const std::vector<double> curvature = products(direction, image, channels);
    std::vector<double> step(channels, 0), turn(channels, 0);  // alpha, beta; a channel that is done stands still
    for (std::size_t c = 0; c < channels; ++c) step[c] = squared[c] > goal[c] ? squared[c] / curvature[c] : 0;
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= step[i % channels] * image[i];
    const std::vector<double> before = squared;
    squared = products(residual, residual, channels);
    for (std::size_t c = 0; c < channels; ++c) turn[c] = step[c] > 0 ? squared[c] / before[c] : 0;
    for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = residual[i] + turn[i % channels] * direction[i];
    for (Shifted& system : systems) {
      // One whose own residual is small enough stands still: its zeta would fall until nothing is left of it.
      std::vector<double> own = step;
      for (std::size_t c = 0; c < channels; ++c)
        if (system.zeta[c] * system.zeta[c] * before[c] <= goal[c]) own[c] = 0;
      advance(system, residual, own, step_before, turn, turn_before);
    }
    for (std::size_t c = 0; c < channels; ++c)
      if (step[c] > 0) step_before[c] = step[c], turn_before[c] = turn[c];
  }
  std::vector<std::vector<double>> solutions;
  for (Shifted& system : systems) solutions.push_back(std::move(system.solution));
  return solutions;
}

void OptimalInterpolation::advance(Shifted& system, std::span<const double> residual, std::span<const double> step,
                                   std::span<const double> step_before, std::span<const double> turn,
                                   std::span<const double> turn_before) {
  const std::size_t channels = step.size();
  std::vector<double> own_step(channels, 0), own_turn(channels, 0);
  for (std::size_t c = 0; c < channels; ++c) {
    if (step[c] == 0) continue;
    const double zeta = system.zeta[c], before = system.zeta_before[c];
    const double next =
        zeta * before * step_before[c] /
        (step_before[c] * before * (1 + system.shift * step[c]) + step[c] * turn_before[c] * (before - zeta));
    own_step[c] = step[c] * next / zeta;
    own_turn[c] = turn[c] * (next / zeta) * (next / zeta);
    system.zeta_before[c] = zeta;
    system.zeta[c] = next;
  }
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const std::size_t c = i % channels;
    if (step[c] == 0) continue;
    system.solution[i] += own_step[c] * system.direction[i];
    system.direction[i] = system.zeta[c] * residual[i] + own_turn[c] * system.direction[i];
  }
}

std::vector<std::vector<double>> OptimalInterpolation::estimates(std::span<const double> values, std::size_t channels,
                                                                 std::span<const double> error_ratios,
                                                                 double tolerance) const {
  assert(values.size() == (among_observations_.begin.size() - 1) * channels);
  std::vector<std::vector<double>> results = solve(values, channels, error_ratios, tolerance);
  for (std::vector<double>& each : results) {
    const std::vector<double> solution = std::move(each);
    multiply(at_targets_, solution, channels, each);
  }
  return results;
}

std::vector<double> OptimalInterpolation::estimate(std::span<const double> values, std::size_t channels,
                                                   double error_ratio) const {
  return std::move(estimates(values, channels, std::span(&error_ratio, 1)).front());
}

}  // namespace thin
