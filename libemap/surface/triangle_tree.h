#pragma once

// Closest points on a triangle mesh, by a tree of bounding boxes.
//
// Building is O(n log n) on all cores, a query O(log n) where the point is near the surface. Queries are const and may
// run on many threads; among triangles at the same distance any may be reported, always the same one.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libemap/surface/surface.h"

namespace emap {

// The point of triangle abc that is closest to `point`. Degenerate triangles are segments or points.
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

class TriangleTree {
 public:
  // Copies what it needs of the mesh.
  explicit TriangleTree(const Mesh& mesh);

  struct Closest {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double distance_squared = std::numeric_limits<double>::infinity();
    std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();  // index in the mesh; this where there is none
  };

  // The closest point, where it is nearer than the square root of `bound_squared`.
  Closest closest(const Eigen::Vector3d& point, double bound_squared = std::numeric_limits<double>::infinity()) const;

  // Squared distances of many points, on all cores; infinite where there are no triangles.
  std::vector<double> distances_squared(std::span<const Eigen::Vector3d> points) const;

 private:
  struct Node {
    std::array<float, 3> minimum{}, maximum{};  // rounded outwards
    std::uint32_t begin, end;                   // of its triangles
    std::uint32_t left = 0;                     // the child on the left; the other follows it. 0: a leaf
    double distance_squared(const Eigen::Vector3d& point) const;
  };
  struct Corners {
    Eigen::Vector3d a, b, c;
    std::uint32_t triangle;
  };

  struct Centre {
    std::array<float, 3> sum;  // of the corners
    std::uint32_t triangle;
  };

  void add_children(std::uint32_t node);
  void enclose(Node& node) const;

  std::vector<Corners> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace emap
