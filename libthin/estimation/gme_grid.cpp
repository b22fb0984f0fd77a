#include "libthin/estimation/gme_grid.h"

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Vector3 unit(const Vector3& v) {
  const double length = std::hypot(v.x, v.y, v.z);
  return {v.x / length, v.y / length, v.z / length};
}

// Two poles, and two rings of five at latitudes +-atan(1/2), the southern one turned by 36 degrees.
std::vector<Vector3> icosahedron_vertices() {
  std::vector<Vector3> vertices = {{0, 0, 1}, {0, 0, -1}};
  const double latitude = std::atan(0.5);
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 5; ++i) {
      const double longitude = (i + 0.5 * ring) * 2 * std::numbers::pi / 5;
      vertices.push_back({std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                          ring == 0 ? std::sin(latitude) : -std::sin(latitude)});
    }
  return vertices;
}

std::vector<Triangle> icosahedron_triangles() {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t next = (i + 1) % 5;
    const std::uint32_t north = 2 + i, north_next = 2 + next, south = 7 + i, south_next = 7 + next;
    triangles.push_back({0, north, north_next});
    triangles.push_back({north, south, north_next});
    triangles.push_back({north_next, south, south_next});
    triangles.push_back({1, south_next, south});
  }
  return triangles;
}

// Gives each edge one midpoint, whichever of its two triangles asks first.
class EdgeMidpoints {
 public:
  EdgeMidpoints(std::vector<Vector3>& vertices, std::size_t edges) : vertices_(vertices) { midpoints_.reserve(edges); }

  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    const auto [place, is_new] = midpoints_.try_emplace(edge, static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) {
      const Vector3 &p = vertices_[a], &q = vertices_[b];
      vertices_.push_back(unit({p.x + q.x, p.y + q.y, p.z + q.z}));
    }
    return place->second;
  }

 private:
  std::vector<Vector3>& vertices_;
  std::unordered_map<std::uint64_t, std::uint32_t> midpoints_;
};

std::vector<Triangle> subdivided(const std::vector<Triangle>& triangles, std::vector<Vector3>& vertices) {
  EdgeMidpoints midpoints(vertices, triangles.size() * 3 / 2);
  std::vector<Triangle> finer;
  finer.reserve(triangles.size() * 4);
  for (const auto& [a, b, c] : triangles) {
    const std::uint32_t ab = midpoints.of(a, b), bc = midpoints.of(b, c), ca = midpoints.of(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return finer;
}

// Along the geocentric direction, onto the ellipsoid.
Vector3 on_ellipsoid(const Vector3& direction) {
  constexpr double equatorial_km = 6378.137;
  constexpr double polar_km = equatorial_km * (1 - 1 / 298.257223563);
  const double scale =
      1 / std::sqrt((direction.x * direction.x + direction.y * direction.y) / (equatorial_km * equatorial_km) +
                    direction.z * direction.z / (polar_km * polar_km));
  return {direction.x * scale, direction.y * scale, direction.z * scale};
}

}  // namespace

std::vector<Vector3> gme_grid(int level) {
  assert(level >= 0 && level <= kMaximumGmeLevel);
  std::vector<Vector3> vertices = icosahedron_vertices();
  std::vector<Triangle> triangles = icosahedron_triangles();
  for (int i = 0; i < level; ++i) triangles = subdivided(triangles, vertices);
  for (Vector3& vertex : vertices) vertex = on_ellipsoid(vertex);
  return vertices;
}

}  // namespace thin
