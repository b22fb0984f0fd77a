#include "libemap/elevation/base_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/partition/footprints.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Counter-clockwise, by Andrew's monotone chain. Reorders the points.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d>& points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  std::vector<Eigen::Vector2d> hull;
  const auto extend = [&](const Eigen::Vector2d& point, std::size_t least) {
    while (hull.size() >= least + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
    hull.push_back(point);
  };
  for (const Eigen::Vector2d& point : points) extend(point, 0);
  const std::size_t lower = hull.size();
  for (auto point = points.rbegin(); point != points.rend(); ++point) extend(*point, lower - 1);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

struct Rectangle {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // of its first side
  Eigen::Vector2d minimum = Eigen::Vector2d::Zero();     // along the direction, and across it
  double area = std::numeric_limits<double>::infinity();
};

Rectangle rectangle_along(const Eigen::Vector2d& direction, const std::vector<Eigen::Vector2d>& hull) {
  const Eigen::Vector2d across(-direction.y(), direction.x());
  Eigen::Vector2d minimum = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d maximum = -minimum;
  for (const Eigen::Vector2d& point : hull) {
    const Eigen::Vector2d place(direction.dot(point), across.dot(point));
    minimum = minimum.cwiseMin(place);
    maximum = maximum.cwiseMax(place);
  }
  return {direction, minimum, (maximum - minimum).prod()};
}

// The least bounding rectangle of a convex polygon has a side along one of its edges.
Rectangle least_rectangle(const std::vector<Eigen::Vector2d>& hull) {
  Rectangle best = rectangle_along(Eigen::Vector2d::UnitX(), hull);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    if (!(edge.norm() > 0)) continue;
    const Rectangle rectangle = rectangle_along(edge.normalized(), hull);
    if (rectangle.area < best.area * (1 - 1e-12)) best = rectangle;
  }
  return best;
}

BasePlane plane_around(const Eigen::Vector3d& normal, const std::vector<Eigen::Vector3d>& positions) {
  const BasePlane frame = plane_with_normal(normal);
  double lowest = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Vector2d> projected;
  projected.reserve(positions.size());
  for (const Eigen::Vector3d& position : positions) {
    projected.emplace_back(frame.axis_u.dot(position), frame.axis_v.dot(position));
    lowest = std::min(lowest, normal.dot(position));
  }
  const Rectangle rectangle = least_rectangle(convex_hull(projected));
  BasePlane plane;
  plane.normal = normal;
  plane.axis_u = rectangle.direction.x() * frame.axis_u + rectangle.direction.y() * frame.axis_v;
  plane.axis_v = normal.cross(plane.axis_u);
  plane.origin = rectangle.minimum.x() * plane.axis_u + rectangle.minimum.y() * plane.axis_v + lowest * normal;
  return plane;
}

// `append(element, positions)` appends the positions that an element spans.
template <class Append>
std::vector<BasePlane> planes_of(const Partition& partition, const Append& append) {
  const std::vector<std::vector<std::uint32_t>> elements = partition.elements_of_patches();
  std::vector<BasePlane> planes(partition.patches.size());
  thin::parallel_ranges(planes.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<Eigen::Vector3d> positions;
    for (std::size_t patch = begin; patch < end; ++patch) {
      positions.clear();
      for (const std::uint32_t element : elements[patch]) append(element, positions);
      planes[patch] = plane_around(partition.patches[patch].normal, positions);
    }
  });
  return planes;
}

}  // namespace

BasePlane plane_with_normal(const Eigen::Vector3d& normal) {
  const PlaneAxes axes = axes_around(normal);
  return {Eigen::Vector3d::Zero(), axes.u, axes.v, axes.normal};
}

std::vector<BasePlane> base_planes(const Mesh& mesh, const Partition& partition) {
  return planes_of(partition, [&](std::uint32_t element, std::vector<Eigen::Vector3d>& positions) {
    for (const std::uint32_t vertex : mesh.triangles[element]) positions.push_back(mesh.positions[vertex]);
  });
}

std::vector<BasePlane> base_planes(const PointSet& points, const Partition& partition) {
  return planes_of(partition, [&](std::uint32_t element, std::vector<Eigen::Vector3d>& positions) {
    positions.push_back(points.positions[element]);
  });
}

}  // namespace emap
