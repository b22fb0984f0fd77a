#include "libemap/surface/point_mesh.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/point_neighbours.h"

namespace emap {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using DelaunayPoint = Kernel::Point_3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t kSpacingNeighbours = 8;
constexpr double kScatter = 0.02;  // in spacings

// In [-0.5, 0.5), by the coordinate's bits and the axis.
double scatter(const Eigen::Vector3d& position, std::uint64_t axis) {
  std::uint64_t hash = axis + 1;
  for (const double x : position) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 32;
  }
  return static_cast<double>(hash >> 11) * 0x1p-53 - 0.5;
}

// Points of lattices and spheres lie on common spheres, between which a Delaunay triangulation has no choice; scattered
// a little they don't. The same for the same position.
DelaunayPoint scattered(const Eigen::Vector3d& position, double spacing) {
  const double size = kScatter * spacing;
  return {position.x() + size * scatter(position, 0), position.y() + size * scatter(position, 1),
          position.z() + size * scatter(position, 2)};
}

// CGAL compares cells and vertices by where they lie in memory, which differs from run to run, unless they are
// numbered.
template <class Base>
class Numbered : public Base {
 public:
  using Base::Base;
  template <class Structure>
  struct Rebind_TDS {
    using Other = Numbered<typename Base::template Rebind_TDS<Structure>::Other>;
  };

  using Has_timestamp = CGAL::Tag_true;
  std::size_t time_stamp() const { return number_; }
  void set_time_stamp(std::size_t number) { number_ = number; }

 private:
  std::size_t number_ = static_cast<std::size_t>(-1);  // CGAL's "not yet"
};

// So it does with the front's edges whose best triangles are equally good; here the numbers of the edge's points
// decide.
template <class Base>
class FrontVertex : public Base {
 public:
  using Base::Base;
  template <class Structure>
  struct Rebind_TDS {
    using Other = FrontVertex<typename Base::template Rebind_TDS<Structure>::Other>;
  };

  // CGAL's name for an edge in the queue of the front.
  struct Radius_ptr_type {
    Radius_ptr_type(typename Base::criteria value, typename Base::IO_edge_type* edge) : first(value), second(edge) {
      const auto& [cell, from, to] = edge->first.first;
      ends = std::minmax(cell->vertex(from)->info(), cell->vertex(to)->info());
    }
    bool operator<(const Radius_ptr_type& other) const {
      return std::tie(first, ends, second) < std::tie(other.first, other.ends, other.second);
    }
    typename Base::criteria first;
    typename Base::IO_edge_type* second;
    std::pair<std::size_t, std::size_t> ends;
  };
};

using Vertex = Numbered<FrontVertex<CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel>>>;
using Cell = Numbered<CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

std::vector<Triangle> advancing_front(const std::vector<Eigen::Vector3d>& positions,
                                      const std::vector<double>& spacings) {
  std::vector<std::pair<DelaunayPoint, std::size_t>> points;
  points.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) points.emplace_back(scattered(positions[i], spacings[i]), i);
  Triangulation triangulation;
  triangulation.insert(points.begin(), points.end());
  CGAL::Advancing_front_surface_reconstruction<Triangulation> front(triangulation);
  front.run();
  std::vector<std::array<std::size_t, 3>> found;
  CGAL::write_triple_indices(std::back_inserter(found), front);
  std::vector<Triangle> triangles;
  triangles.reserve(found.size());
  for (const auto& [a, b, c] : found)
    triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  return triangles;
}

// The front goes on over whatever lies between the points; what is wider than the points' spacing is none of theirs.
void drop_bridges(const std::vector<Eigen::Vector3d>& positions, const std::vector<double>& spacings, double reach,
                  std::vector<Triangle>& triangles) {
  const auto is_bridge = [&](const Triangle& triangle) {
    double spacing = 0, longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      spacing = std::max(spacing, spacings[triangle[i]]);
      longest = std::max(longest, (positions[triangle[i]] - positions[triangle[(i + 1) % 3]]).norm());
    }
    return longest > reach * spacing;
  };
  std::erase_if(triangles, is_bridge);
}

std::vector<double> spacings_of(const std::vector<Eigen::Vector3d>& positions) {
  const PointNeighbours neighbours(positions, tree_of(positions), kSpacingNeighbours);
  std::vector<double> spacings(positions.size());
  for (std::uint32_t point = 0; point < spacings.size(); ++point) spacings[point] = neighbours.spacing(point);
  return spacings;
}

// Of each triangle, the smallest triangle of the part that it is connected to over edges.
std::vector<std::uint32_t> connected_parts(const Mesh& mesh) {
  std::vector<std::uint32_t> part(mesh.triangles.size());
  std::iota(part.begin(), part.end(), 0U);
  const auto root = [&](std::uint32_t triangle) {
    while (part[triangle] != triangle) triangle = part[triangle] = part[part[triangle]];
    return triangle;
  };
  for (const EdgePair& edge : edge_pairs(mesh)) {
    const std::uint32_t first = root(edge.first_triangle), second = root(edge.second_triangle);
    part[std::max(first, second)] = std::min(first, second);
  }
  for (std::uint32_t triangle = 0; triangle < part.size(); ++triangle) part[triangle] = root(triangle);
  return part;
}

// Within a connected part the front's triangles are turned alike.
void turn_outwards(const std::vector<Eigen::Vector3d>& normals, Mesh& mesh) {
  const std::vector<std::uint32_t> part = connected_parts(mesh);
  std::vector<double> agreement(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    const Eigen::Vector3d scaled = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    agreement[part[i]] += scaled.dot(normals[a] + normals[b] + normals[c]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (agreement[part[i]] < 0) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
}

// The front's triangles come in no order that would be the same each time.
void put_in_order(std::vector<Triangle>& triangles) {
  for (Triangle& triangle : triangles)
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  std::sort(triangles.begin(), triangles.end());
}

}  // namespace

Mesh mesh_of_points(const PointSet& points, const PointMeshOptions& options) {
  assert(points.normals.size() == points.positions.size());
  Mesh mesh{points.positions, {}};
  if (points.positions.size() < 3) return mesh;
  const std::vector<double> spacings = spacings_of(points.positions);
  // Where all points are at one place there is nothing to triangulate.
  if (!(*std::max_element(spacings.begin(), spacings.end()) > 0)) return mesh;
  mesh.triangles = advancing_front(points.positions, spacings);
  drop_bridges(points.positions, spacings, options.reach, mesh.triangles);
  turn_outwards(points.normals, mesh);
  put_in_order(mesh.triangles);
  return mesh;
}

}  // namespace emap
