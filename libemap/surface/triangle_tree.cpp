#include "libemap/surface/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr std::size_t kGrain = 4096;

Eigen::Vector3d closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length_squared = along.squaredNorm();
  if (!(length_squared > 0)) return a;
  return a + std::clamp(along.dot(point - a) / length_squared, 0.0, 1.0) * along;
}

}  // namespace

Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  // Inside where the projection has all barycentric coordinates >= 0; otherwise on a side beyond which it lies.
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a;
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm(), pb = ap.dot(ab), pc = ap.dot(ac);
  const double determinant = bb * cc - bc * bc;
  const double v = cc * pb - bc * pc, w = bb * pc - bc * pb;
  const bool is_line = !(determinant > 1e-14 * bb * cc);
  const bool beyond_ac = v < 0 || is_line, beyond_ab = w < 0 || is_line, beyond_bc = v + w > determinant || is_line;
  if (!beyond_ac && !beyond_ab && !beyond_bc) return a + (v / determinant) * ab + (w / determinant) * ac;
  Eigen::Vector3d best = a;
  double best_squared = std::numeric_limits<double>::infinity();
  const auto try_side = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d candidate = closest_on_segment(point, from, to);
    if (const double squared = (candidate - point).squaredNorm(); squared < best_squared)
      best = candidate, best_squared = squared;
  };
  if (beyond_ab) try_side(a, b);
  if (beyond_bc) try_side(b, c);
  if (beyond_ac) try_side(a, c);
  return best;
}

namespace {

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest <= value ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

// Two halves along the longest axis.
template <class Centre>
void part(std::span<Centre> centres) {
  if (centres.size() <= kLeafSize) return;
  std::array<float, 3> low = centres[0].sum, high = low;
  for (const Centre& centre : centres)
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], centre.sum[i]);
      high[i] = std::max(high[i], centre.sum[i]);
    }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(centres.size() / 2);
  std::nth_element(centres.begin(), middle, centres.end(), [axis](const Centre& a, const Centre& b) {
    return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis] : a.triangle < b.triangle;
  });
}

}  // namespace

double TriangleTree::Node::distance_squared(const Eigen::Vector3d& point) const {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double coordinate = point[static_cast<Eigen::Index>(i)];
    const double outside = std::max({minimum[i] - coordinate, coordinate - maximum[i], 0.0});
    sum += outside * outside;
  }
  return sum;
}

TriangleTree::TriangleTree(const Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  std::vector<Centre> centres(mesh.triangles.size());
  thin::parallel_ranges(centres.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& corners = mesh.triangles[i];
      const Eigen::Vector3f sum =
          (mesh.positions[corners[0]] + mesh.positions[corners[1]] + mesh.positions[corners[2]]).cast<float>();
      centres[i] = {{sum.x(), sum.y(), sum.z()}, static_cast<std::uint32_t>(i)};
    }
  });
  nodes_.push_back({{}, {}, 0, static_cast<std::uint32_t>(centres.size())});
  // Level by level: the nodes of one have disjoint triangles, and their children come behind them in order.
  for (std::size_t first = 0; first < nodes_.size();) {
    const std::size_t last = nodes_.size();
    thin::parallel_ranges(last - first, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = first + begin; node < first + end; ++node)
        part(std::span(centres).subspan(nodes_[node].begin, nodes_[node].end - nodes_[node].begin));
    });
    for (std::size_t node = first; node < last; ++node) add_children(static_cast<std::uint32_t>(node));
    first = last;
  }
  triangles_.resize(centres.size());
  thin::parallel_ranges(centres.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& corners = mesh.triangles[centres[i].triangle];
      triangles_[i] = {mesh.positions[corners[0]], mesh.positions[corners[1]], mesh.positions[corners[2]],
                       centres[i].triangle};
    }
  });
  for (std::size_t node = nodes_.size(); node-- > 0;) enclose(nodes_[node]);
}

void TriangleTree::add_children(std::uint32_t node) {
  const std::uint32_t begin = nodes_[node].begin, end = nodes_[node].end, middle = begin + (end - begin) / 2;
  if (end - begin <= kLeafSize) return;
  nodes_[node].left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, begin, middle});
  nodes_.push_back({{}, {}, middle, end});
}

// The children's bounds are there already.
void TriangleTree::enclose(Node& node) const {
  if (node.left != 0) {
    const Node &left = nodes_[node.left], &right = nodes_[node.left + 1];
    for (std::size_t i = 0; i < 3; ++i) {
      node.minimum[i] = std::min(left.minimum[i], right.minimum[i]);
      node.maximum[i] = std::max(left.maximum[i], right.maximum[i]);
    }
    return;
  }
  Eigen::Array3d minimum = triangles_[node.begin].a, maximum = minimum;
  for (std::uint32_t i = node.begin; i < node.end; ++i)
    for (const Eigen::Vector3d& corner : {triangles_[i].a, triangles_[i].b, triangles_[i].c}) {
      minimum = minimum.min(corner.array());
      maximum = maximum.max(corner.array());
    }
  for (std::size_t i = 0; i < 3; ++i) {
    node.minimum[i] = rounded_down(minimum[static_cast<Eigen::Index>(i)]);
    node.maximum[i] = -rounded_down(-maximum[static_cast<Eigen::Index>(i)]);
  }
}

TriangleTree::Closest TriangleTree::closest(const Eigen::Vector3d& point, double bound_squared) const {
  Closest best;
  best.distance_squared = bound_squared;
  if (nodes_.empty()) return best;
  struct Waiting {
    std::uint32_t node;
    double distance_squared;
  };
  std::array<Waiting, 96> stack;  // the tree is balanced: far deeper than 2^32 triangles make it
  std::size_t waiting = 0;
  stack[waiting++] = {0, nodes_[0].distance_squared(point)};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.distance_squared >= best.distance_squared) continue;
    const Node& node = nodes_[next.node];
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const Corners& corners = triangles_[i];
        const Eigen::Vector3d candidate = closest_on_triangle(point, corners.a, corners.b, corners.c);
        const double distance_squared = (candidate - point).squaredNorm();
        if (distance_squared < best.distance_squared) best = {candidate, distance_squared, corners.triangle};
      }
      continue;
    }
    Waiting near{node.left, nodes_[node.left].distance_squared(point)};
    Waiting far{node.left + 1, nodes_[node.left + 1].distance_squared(point)};
    if (far.distance_squared < near.distance_squared) std::swap(near, far);
    stack[waiting++] = far;
    stack[waiting++] = near;
  }
  return best;
}

std::vector<double> TriangleTree::distances_squared(std::span<const Eigen::Vector3d> points) const {
  std::vector<double> distances(points.size());
  thin::parallel_ranges(points.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) distances[i] = closest(points[i]).distance_squared;
  });
  return distances;
}

}  // namespace emap
