#include "libemap/surface/point_neighbours.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/foundation/parallel.h"

namespace emap {

thin::KdTree tree_of(const std::vector<Eigen::Vector3d>& positions) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  return thin::KdTree({positions.empty() ? nullptr : positions.front().data(), 3 * positions.size()}, 3);
}

PointNeighbours::PointNeighbours(const std::vector<Eigen::Vector3d>& positions, const thin::KdTree& tree,
                                 std::size_t count)
    : count_(std::min(count, positions.empty() ? 0 : positions.size() - 1)),
      indices_(positions.size() * count_),
      farthest_(positions.size(), 0) {
  thin::parallel_ranges(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<thin::Neighbour> found;
    for (std::size_t point = begin; point < end; ++point) {
      tree.nearest({positions[point].data(), 3}, count_ + 1, found);
      // Among many points at one place the point itself may not be found: then the last one goes.
      const auto self = std::find_if(found.begin(), found.end(), [&](const auto& n) { return n.index == point; });
      found.erase(self != found.end() ? self : found.end() - 1);
      for (std::size_t i = 0; i < count_; ++i) indices_[point * count_ + i] = found[i].index;
      if (count_ > 0) farthest_[point] = std::sqrt(found[count_ - 1].distance_squared);
    }
  });
}

double PointNeighbours::spacing(std::uint32_t point) const {
  // The disc that reaches the last neighbour holds the point, the others, and half of the last.
  return farthest_[point] * std::sqrt(std::numbers::pi / (static_cast<double>(count_) + 0.5));
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbour_pairs(const PointNeighbours& neighbours,
                                                                     std::size_t count) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(neighbours.point_count() * count);
  for (std::uint32_t point = 0; point < neighbours.point_count(); ++point) {
    const std::span<const std::uint32_t> nearest = neighbours.of(point);
    for (std::size_t i = 0; i < std::min(count, nearest.size()); ++i)
      pairs.emplace_back(std::min(point, nearest[i]), std::max(point, nearest[i]));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace emap
