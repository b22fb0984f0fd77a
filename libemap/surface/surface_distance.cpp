#include "libemap/surface/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "libemap/surface/bounding_box.h"
#include "libemap/surface/mls_surface.h"
#include "libemap/surface/surface_samples.h"
#include "libemap/surface/triangle_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

using DistanceSquared = std::function<double(const Eigen::Vector3d&)>;

std::vector<Eigen::Vector3d> samples_of(const Model& model, const ComparisonOptions& options, std::uint64_t salt) {
  if (!model.is_mesh()) return model.positions;
  return sample_surface({model.positions, model.triangles}, options.samples, options.seed + salt);
}

DistanceSquared distance_to(const Model& model) {
  if (!model.is_mesh()) {
    const auto surface = std::make_shared<MlsSurface>(model.positions);
    return [surface](const Eigen::Vector3d& point) { return (surface->closest(point).position - point).squaredNorm(); };
  }
  const auto tree = std::make_shared<TriangleTree>(Mesh{model.positions, model.triangles});
  return [tree](const Eigen::Vector3d& point) { return tree->closest(point).distance_squared; };
}

// Sums are taken over the samples in order, whoever computed them.
OneSidedDistance distance_of(const std::vector<Eigen::Vector3d>& samples, const DistanceSquared& distance_squared) {
  std::vector<double> squares(samples.size());
  thin::parallel_ranges(samples.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) squares[i] = distance_squared(samples[i]);
  });
  double sum = 0, largest = 0;
  for (const double square : squares) {
    sum += square;
    largest = std::max(largest, square);
  }
  return {std::sqrt(sum / static_cast<double>(samples.size())), std::sqrt(largest)};
}

// Vertices that no triangle uses do not count.
double diagonal_of(const Model& model) {
  if (!model.is_mesh()) return bounding_box(model.positions).diagonal();
  std::vector<Eigen::Vector3d> used;
  used.reserve(3 * model.triangles.size());
  for (const auto& triangle : model.triangles)
    for (const std::uint32_t vertex : triangle) used.push_back(model.positions[vertex]);
  return bounding_box(used).diagonal();
}

}  // namespace

double SurfaceComparison::error() const {
  return std::max(first_to_second.root_mean_square, second_to_first.root_mean_square);
}

double SurfaceComparison::error_in_1e4() const {
  return error() / diagonal * 1e4;
}

double SurfaceComparison::psnr_db() const {
  return error() > 0 ? 20 * std::log10(diagonal / error()) : std::numeric_limits<double>::infinity();
}

Result<SurfaceComparison> compare_surfaces(const Model& first, const Model& second, const ComparisonOptions& options) {
  const std::vector<Eigen::Vector3d> first_samples = samples_of(first, options, 0);
  const std::vector<Eigen::Vector3d> second_samples = samples_of(second, options, 1);
  if (first_samples.empty()) return Error{ErrorKind::input, "the first surface is empty: no points, or no area"};
  if (second_samples.empty()) return Error{ErrorKind::input, "the second surface is empty: no points, or no area"};
  SurfaceComparison comparison;
  comparison.diagonal = diagonal_of(first);
  comparison.first_to_second = distance_of(first_samples, distance_to(second));
  comparison.second_to_first = distance_of(second_samples, distance_to(first));
  return comparison;
}

}  // namespace emap
