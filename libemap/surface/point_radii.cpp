#include "libemap/surface/point_radii.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

#include "libemap/surface/point_neighbours.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::size_t kNeighbours = 12;

double radius_of(const PointSet& points, std::uint32_t point, std::span<const std::uint32_t> neighbours) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Delaunay = CGAL::Delaunay_triangulation_2<Kernel>;
  const Eigen::Vector3d& normal = points.normals[point];
  Eigen::Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = Eigen::Vector3d::Unit(least).cross(normal).normalized(), v = normal.cross(u);
  Delaunay triangulation;
  const Delaunay::Vertex_handle centre = triangulation.insert({0, 0});
  for (const std::uint32_t neighbour : neighbours) {
    const Eigen::Vector3d offset = points.positions[neighbour] - points.positions[point];
    triangulation.insert({u.dot(offset), v.dot(offset)});
  }
  if (triangulation.number_of_vertices() < 2) return 0;
  double longest_squared = 0;
  auto edge = triangulation.incident_vertices(centre);
  const auto start = edge;
  do {
    if (!triangulation.is_infinite(edge))
      longest_squared = std::max(longest_squared, CGAL::squared_distance(edge->point(), centre->point()));
  } while (++edge != start);
  return std::sqrt(longest_squared);
}

}  // namespace

std::vector<double> delaunay_radii(const PointSet& points) {
  const thin::KdTree tree = tree_of(points.positions);
  const PointNeighbours neighbours(points.positions, tree, kNeighbours);
  std::vector<double> radii(points.positions.size());
  thin::parallel_ranges(radii.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (auto point = static_cast<std::uint32_t>(begin); point < end; ++point)
      radii[point] = radius_of(points, point, neighbours.of(point));
  });
  return radii;
}

}  // namespace emap
