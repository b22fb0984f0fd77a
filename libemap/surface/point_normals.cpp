#include "libemap/surface/point_normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "libthin/foundation/indexed_priority_queue.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

Eigen::Vector3d fitted_normal(const std::vector<Eigen::Vector3d>& positions, std::uint32_t point,
                              std::span<const std::uint32_t> neighbours) {
  double mean_squared = 0;
  for (const std::uint32_t neighbour : neighbours)
    mean_squared += (positions[neighbour] - positions[point]).squaredNorm();
  if (!(mean_squared > 0)) return Eigen::Vector3d::UnitZ();
  mean_squared /= static_cast<double>(neighbours.size());
  const auto weight = [&](std::uint32_t other) {
    return std::exp(-(positions[other] - positions[point]).squaredNorm() / mean_squared);
  };
  double total = 1;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // relative to the point, which has weight 1
  for (const std::uint32_t neighbour : neighbours) {
    total += weight(neighbour);
    centre += weight(neighbour) * (positions[neighbour] - positions[point]);
  }
  centre /= total;
  Eigen::Matrix3d covariance = centre * centre.transpose();
  for (const std::uint32_t neighbour : neighbours) {
    const Eigen::Vector3d offset = positions[neighbour] - positions[point] - centre;
    covariance += weight(neighbour) * offset * offset.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

// Prim's algorithm from one point over its connected part; normals are flipped as they join the tree.
class Orientation {
 public:
  Orientation(const std::vector<Eigen::Vector3d>& positions, const PointNeighbours& neighbours,
              std::vector<Eigen::Vector3d>& normals)
      : positions_(positions),
        normals_(normals),
        first_(positions.size() + 1, 0),
        parent_(positions.size(), 0),
        in_tree_(positions.size(), false),
        queue_(positions.size()) {
    const auto pairs = neighbour_pairs(neighbours, kNormalNeighbours);
    for (const auto& [a, b] : pairs) ++first_[a + 1], ++first_[b + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    adjacent_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [a, b] : pairs) adjacent_[next[a]++] = b, adjacent_[next[b]++] = a;
  }

  void run() {
    std::vector<std::uint32_t> by_height(positions_.size());
    std::iota(by_height.begin(), by_height.end(), 0U);
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return positions_[a].z() > positions_[b].z(); });
    for (const std::uint32_t root : by_height) {
      if (in_tree_[root]) continue;
      if (normals_[root].z() < 0) normals_[root] = -normals_[root];
      join(root);
      while (!queue_.empty()) {
        const std::uint32_t point = queue_.pop();
        if (normals_[point].dot(normals_[parent_[point]]) < 0) normals_[point] = -normals_[point];
        join(point);
      }
    }
  }

 private:
  void join(std::uint32_t point) {
    in_tree_[point] = true;
    for (std::uint32_t i = first_[point]; i < first_[point + 1]; ++i) {
      const std::uint32_t other = adjacent_[i];
      if (in_tree_[other]) continue;
      const double weight = 1 - std::abs(normals_[point].dot(normals_[other]));
      if (!queue_.contains(other))
        queue_.push(other, weight), parent_[other] = point;
      else if (weight < queue_.key(other))
        queue_.update(other, weight), parent_[other] = point;
    }
  }

  const std::vector<Eigen::Vector3d>& positions_;
  std::vector<Eigen::Vector3d>& normals_;
  std::vector<std::uint32_t> first_, adjacent_, parent_;
  std::vector<bool> in_tree_;
  thin::IndexedPriorityQueue<double> queue_;
};

}  // namespace

std::vector<Eigen::Vector3d> fitted_normals(const std::vector<Eigen::Vector3d>& positions,
                                            const PointNeighbours& neighbours) {
  std::vector<Eigen::Vector3d> normals(positions.size());
  thin::parallel_ranges(positions.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point)
      normals[point] = fitted_normal(positions, point, neighbours.of(point));
  });
  return normals;
}

void orient_normals(const std::vector<Eigen::Vector3d>& positions, const PointNeighbours& neighbours,
                    std::vector<Eigen::Vector3d>& normals) {
  Orientation(positions, neighbours, normals).run();
}

void ensure_normals(PointSet& points) {
  if (!points.normals.empty()) return;
  const thin::KdTree tree = tree_of(points.positions);
  const PointNeighbours neighbours(points.positions, tree, kNormalNeighbours);
  points.normals = fitted_normals(points.positions, neighbours);
  orient_normals(points.positions, neighbours, points.normals);
}

}  // namespace emap
