#include "libemap/elevation/triangle_crossing.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <algorithm>

namespace emap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// The corner at `shared`, then the other two in order.
std::array<std::uint32_t, 3> from(const std::array<std::uint32_t, 3>& triangle, std::uint32_t shared) {
  const auto place = static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), shared) - triangle.begin());
  return {triangle[place], triangle[(place + 1) % 3], triangle[(place + 2) % 3]};
}

class Crossing {
 public:
  explicit Crossing(const std::vector<Eigen::Vector3d>& positions) : positions_(positions) {}

  bool apart(const std::array<std::uint32_t, 3>& first, const std::array<std::uint32_t, 3>& second) const {
    return CGAL::do_intersect(triangle(first), triangle(second));
  }

  // Triangles with one vertex in common: they cross where the side opposite to it of one meets the other.
  bool at_vertex(std::uint32_t shared, const std::array<std::uint32_t, 3>& first,
                 const std::array<std::uint32_t, 3>& second) const {
    const auto one = from(first, shared), other = from(second, shared);
    return CGAL::do_intersect(Kernel::Segment_3(point(one[1]), point(one[2])), triangle(second)) ||
           CGAL::do_intersect(Kernel::Segment_3(point(other[1]), point(other[2])), triangle(first));
  }

  // Triangles with an edge in common: they cross where they are folded flat onto each other.
  bool at_edge(std::uint32_t a, std::uint32_t b, std::uint32_t one, std::uint32_t other) const {
    if (CGAL::orientation(point(a), point(b), point(one), point(other)) != CGAL::COPLANAR) return false;
    return CGAL::coplanar_orientation(point(a), point(b), point(one), point(other)) == CGAL::POSITIVE;
  }

 private:
  Point point(std::uint32_t vertex) const {
    const Eigen::Vector3d& position = positions_[vertex];
    return {position.x(), position.y(), position.z()};
  }
  Kernel::Triangle_3 triangle(const std::array<std::uint32_t, 3>& corners) const {
    return {point(corners[0]), point(corners[1]), point(corners[2])};
  }

  const std::vector<Eigen::Vector3d>& positions_;
};

}  // namespace

bool triangles_cross(const std::vector<Eigen::Vector3d>& positions, const std::array<std::uint32_t, 3>& first,
                     const std::array<std::uint32_t, 3>& second) {
  std::array<std::uint32_t, 3> shared{}, first_only{}, second_only{};
  std::size_t shared_count = 0, first_count = 0, second_count = 0;
  for (const std::uint32_t vertex : first)
    if (std::find(second.begin(), second.end(), vertex) != second.end())
      shared[shared_count++] = vertex;
    else
      first_only[first_count++] = vertex;
  for (const std::uint32_t vertex : second)
    if (std::find(first.begin(), first.end(), vertex) == first.end()) second_only[second_count++] = vertex;
  const Crossing crossing(positions);
  if (shared_count == 0) return crossing.apart(first, second);
  if (shared_count == 1) return crossing.at_vertex(shared[0], first, second);
  if (shared_count == 2) return crossing.at_edge(shared[0], shared[1], first_only[0], second_only[0]);
  return true;
}

}  // namespace emap
