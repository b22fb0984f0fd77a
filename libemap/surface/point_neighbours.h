#pragma once

// The nearest neighbours of every point of a set, found once for all that need them.

#include <cstdint>
#include <span>
#include <vector>

#include "libemap/surface/surface.h"
#include "libthin/foundation/kd_tree.h"

namespace emap {

thin::KdTree tree_of(const std::vector<Eigen::Vector3d>& positions);

class PointNeighbours {
 public:
  // The `count` nearest of each point (fewer, where there are fewer), without itself, by distance, then index.
  PointNeighbours(const std::vector<Eigen::Vector3d>& positions, const thin::KdTree& tree, std::size_t count);

  std::size_t point_count() const { return farthest_.size(); }
  std::span<const std::uint32_t> of(std::uint32_t point) const {
    return std::span(indices_).subspan(point * count_, count_);
  }
  // About the distance between neighbouring samples at the point: the side of a square of the area that one point has.
  double spacing(std::uint32_t point) const;

 private:
  std::size_t count_;                   // of each point
  std::vector<std::uint32_t> indices_;  // points x count
  std::vector<double> farthest_;        // distance to the last neighbour
};

// Pairs (a, b), a < b, of which one is among the `count` nearest of the other; each once, sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbour_pairs(const PointNeighbours& neighbours,
                                                                     std::size_t count);

}  // namespace emap
