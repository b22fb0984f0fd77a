#include "libthin/analysis/separation_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

std::vector<double> nearest_distances_km(std::span<const double> coordinates) {
  const KdTree tree(coordinates, 3);
  std::vector<double> distances_km(tree.size());
  parallel_ranges(tree.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(coordinates.subspan(3 * i, 3), 2, found);
      distances_km[i] = std::sqrt(found.back().distance_squared);
    }
  });
  return distances_km;
}

}  // namespace

SeparationStatistics separation_statistics(const ObservationSet& set, std::span<const std::uint32_t> retained) {
  if (retained.size() < 2) return {};
  std::vector<double> coordinates;
  for (const std::uint32_t p : retained) {
    const Vector3& position = set.position_km[p];
    coordinates.insert(coordinates.end(), {position.x, position.y, position.z});
  }
  std::vector<double> distances_km = nearest_distances_km(coordinates);
  std::sort(distances_km.begin(), distances_km.end());
  const auto n = static_cast<double>(distances_km.size());
  const auto percentile = [&](double share) {
    return distances_km[static_cast<std::size_t>(std::max(std::ceil(share * n) - 1, 0.0))];
  };
  return {.minimum_km = distances_km.front(),
          .mean_km = std::accumulate(distances_km.begin(), distances_km.end(), 0.0) / n,
          .percentile_5_km = percentile(0.05),
          .percentile_25_km = percentile(0.25),
          .median_km = percentile(0.5),
          .percentile_75_km = percentile(0.75),
          .percentile_95_km = percentile(0.95)};
}

}  // namespace thin
