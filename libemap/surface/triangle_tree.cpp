#include "libemap/surface/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::uint32_t kLeafSize = 4;

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
  triangles_.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& triangle = mesh.triangles[i];
    triangles_.push_back({mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]], i});
  }
  if (triangles_.empty()) return;
  nodes_.reserve(triangles_.size());
  nodes_.push_back({{}, {}, 0, static_cast<std::uint32_t>(triangles_.size())});
  // Level by level: the nodes of one have disjoint triangles, and their children come behind them in order.
  for (std::size_t first = 0; first < nodes_.size();) {
    const std::size_t last = nodes_.size();
    thin::parallel_ranges(last - first, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) enclose_and_part(nodes_[first + node]);
    });
    for (std::size_t node = first; node < last; ++node) add_children(static_cast<std::uint32_t>(node));
    first = last;
  }
}

// The node's bounds; its triangles in two halves along the longest axis.
void TriangleTree::enclose_and_part(Node& node) {
  const std::uint32_t begin = node.begin, end = node.end;
  Eigen::Array3d minimum = triangles_[begin].a, maximum = minimum, low = Eigen::Array3d::Constant(1e300), high = -low;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Corners& corners = triangles_[i];
    minimum = minimum.min(corners.a.array()).min(corners.b.array()).min(corners.c.array());
    maximum = maximum.max(corners.a.array()).max(corners.b.array()).max(corners.c.array());
    const Eigen::Array3d centre = (corners.a + corners.b + corners.c).array();
    low = low.min(centre);
    high = high.max(centre);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    node.minimum[i] = rounded_down(minimum[static_cast<Eigen::Index>(i)]);
    node.maximum[i] = -rounded_down(-maximum[static_cast<Eigen::Index>(i)]);
  }
  if (end - begin <= kLeafSize) return;
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [axis](const Corners& left, const Corners& right) {
                     const double a = left.a[axis] + left.b[axis] + left.c[axis];
                     const double b = right.a[axis] + right.b[axis] + right.c[axis];
                     return a != b ? a < b : left.triangle < right.triangle;
                   });
}

void TriangleTree::add_children(std::uint32_t node) {
  const std::uint32_t begin = nodes_[node].begin, end = nodes_[node].end, middle = begin + (end - begin) / 2;
  if (end - begin <= kLeafSize) return;
  nodes_[node].left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, begin, middle});
  nodes_.push_back({{}, {}, middle, end});
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
