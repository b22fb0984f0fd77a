#pragma once

// What both halves of lloyd_clustering.h compute with: distances between points, and the mean of a cluster.

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "libthin/foundation/lloyd_clustering.h"

namespace thin {

// The points with rows filled up with zeros to whole groups of lanes, so that distances take few instructions and are
// summed in one order everywhere.
class ClusterRows {
 public:
  explicit ClusterRows(const ClusterPoints& points) : width_((static_cast<std::size_t>(points.dimension) + 3) / 4 * 4) {
    assert(points.place_dimension >= 3 && points.place_dimension <= 16);
    assert(points.dimension >= points.place_dimension);
    assert(points.group.empty() || points.group.size() == points.size());
    const auto dimension = static_cast<std::size_t>(points.dimension);
    coordinates_.resize(points.size() * width_);
    for (std::size_t p = 0; p < points.size(); ++p)
      std::copy_n(points.coordinates.begin() + static_cast<std::ptrdiff_t>(p * dimension), dimension,
                  coordinates_.begin() + static_cast<std::ptrdiff_t>(p * width_));
  }

  std::size_t width() const { return width_; }
  const double* of(std::size_t p) const { return coordinates_.data() + p * width_; }

  double distance_squared(const double* a, const double* b) const {
    double sum[4] = {};
    for (std::size_t i = 0; i < width_; i += 4)
      for (std::size_t lane = 0; lane < 4; ++lane)
        sum[lane] += (a[i + lane] - b[i + lane]) * (a[i + lane] - b[i + lane]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }

 private:
  std::size_t width_;
  std::vector<double> coordinates_;
};

struct ClusterMean {
  std::uint32_t point = 0;
  double error = 0;  // of the cluster
};

// REQUIRES: members ascending, not empty. `centroid` is replaced.
inline ClusterMean mean_of(const ClusterRows& rows, std::span<const std::uint32_t> members,
                           std::vector<double>& centroid) {
  centroid.assign(rows.width(), 0.0);
  for (const std::uint32_t p : members)
    for (std::size_t i = 0; i < rows.width(); ++i) centroid[i] += rows.of(p)[i];
  const auto count = static_cast<double>(members.size());
  for (double& component : centroid) component /= count;

  // Of two members that are equally near to the centroid but for rounding, the first is the mean.
  constexpr double kEquallyNear = 1 - 1e-9;
  ClusterMean mean{members.front(), 0};
  double nearest = rows.distance_squared(rows.of(mean.point), centroid.data());
  for (const std::uint32_t p : members) {
    const double squared = rows.distance_squared(rows.of(p), centroid.data());
    mean.error += squared;
    if (squared < nearest * kEquallyNear) mean.point = p, nearest = squared;
  }
  // About any point, the sum of squares is that about the centroid and as often the squared distance to it.
  mean.error += count * nearest;
  // What is less than the rounding of the coordinates is nothing: all members are the same.
  const double size_squared = std::inner_product(centroid.begin(), centroid.end(), centroid.begin(), 0.0);
  if (mean.error <= count * 1e-28 * size_squared) mean.error = 0;
  return mean;
}

}  // namespace thin
