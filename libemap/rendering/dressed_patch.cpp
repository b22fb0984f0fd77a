#include "libemap/rendering/dressed_patch.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <unordered_set>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/rendering/smooth_normals.h"
#include "libemap/surface/mesh_normals.h"
#include "libemap/surface/triangle_raster.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

// What all patches look at.
struct Surroundings {
  const ElevationMaps& maps;
  const Mesh& surface;
  std::vector<std::uint32_t> patch_of_vertex;
  std::vector<std::uint32_t> first_vertex;  // of each patch
  std::vector<Eigen::Vector3d> normals;     // of the surface's vertices
  std::vector<std::uint32_t> begin_of_vertex, triangles_of_vertex;

  Surroundings(const ElevationMaps& all, const Mesh& closed)
      : maps(all), surface(closed), patch_of_vertex(patches_of_samples(all)), normals(smooth_normals(closed)) {
    first_vertex.assign(maps.patches.size() + 1, 0);
    for (const std::uint32_t patch : patch_of_vertex) ++first_vertex[patch + 1];
    for (std::size_t i = 1; i < first_vertex.size(); ++i) first_vertex[i] += first_vertex[i - 1];
    begin_of_vertex.assign(surface.positions.size() + 1, 0);
    for (const auto& triangle : surface.triangles)
      for (const std::uint32_t vertex : triangle) ++begin_of_vertex[vertex + 1];
    for (std::size_t i = 1; i < begin_of_vertex.size(); ++i) begin_of_vertex[i] += begin_of_vertex[i - 1];
    triangles_of_vertex.resize(begin_of_vertex.back());
    std::vector<std::uint32_t> next(begin_of_vertex.begin(), begin_of_vertex.end() - 1);
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
      for (const std::uint32_t vertex : surface.triangles[t]) triangles_of_vertex[next[vertex]++] = t;
  }

  // Triangles that reach out of the patch, and those around them, `rounds` times; in ascending order.
  std::vector<std::uint32_t> triangles_around(std::uint32_t patch, int rounds) const {
    std::vector<std::uint32_t> front;
    for (std::uint32_t v = first_vertex[patch]; v < first_vertex[patch + 1]; ++v) front.push_back(v);
    std::unordered_set<std::uint32_t> taken, seen;
    for (int round = 0; round < rounds; ++round) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t vertex : front)
        for (std::uint32_t i = begin_of_vertex[vertex]; i < begin_of_vertex[vertex + 1]; ++i) {
          const auto& triangle = surface.triangles[triangles_of_vertex[i]];
          const auto inside = [&](std::uint32_t v) { return patch_of_vertex[v] == patch; };
          if (std::all_of(triangle.begin(), triangle.end(), inside)) continue;
          taken.insert(triangles_of_vertex[i]);
          for (const std::uint32_t v : triangle)
            if (!inside(v) && seen.insert(v).second) next.push_back(v);
        }
      front = std::move(next);
    }
    std::vector<std::uint32_t> sorted(taken.begin(), taken.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }
};

Eigen::Vector3d along_axes(const BasePlane& plane, const Eigen::Vector3d& direction) {
  return {direction.dot(plane.axis_u), direction.dot(plane.axis_v), direction.dot(plane.normal)};
}

class Dresser {
 public:
  Dresser(const Surroundings& around, std::uint32_t patch, int rims)
      : around_(around), map_(around.maps.patches[patch]), patch_(patch), rims_(rims) {}

  DressedPatch run() {
    const auto rims = static_cast<std::uint32_t>(rims_);
    dressed_.map.plane = map_.plane;
    if (map_.columns == 0 || map_.rows == 0) return dressed_;
    dressed_.map.plane.origin -= rims * around_.maps.spacing * (map_.plane.axis_u + map_.plane.axis_v);
    dressed_.map.columns = map_.columns + 2 * rims;
    dressed_.map.rows = map_.rows + 2 * rims;
    const std::size_t places = std::size_t{dressed_.map.columns} * dressed_.map.rows;
    dressed_.ring.assign(places, 0);
    dressed_.map.mask.assign(places, 0);
    dressed_.map.elevation.assign(places, 0);
    dressed_.normal.assign(places, Eigen::Vector3f::UnitZ());
    take_own_samples();
    if (rims_ > 0) add_rims();
    for (std::size_t place = 0; place < places; ++place) dressed_.map.mask[place] = dressed_.ring[place] ? 1 : 0;
    return std::move(dressed_);
  }

 private:
  void take_own_samples() {
    std::uint32_t vertex = around_.first_vertex[patch_];
    const auto rims = static_cast<std::uint32_t>(rims_);
    for (std::uint32_t row = 0; row < map_.rows; ++row)
      for (std::uint32_t column = 0; column < map_.columns; ++column) {
        const std::size_t from = std::size_t{row} * map_.columns + column;
        if (!map_.mask[from]) continue;
        const std::size_t to = std::size_t{row + rims} * dressed_.map.columns + column + rims;
        dressed_.ring[to] = 1;
        dressed_.map.elevation[to] = map_.elevation[from];
        set_normal(to, along_axes(map_.plane, around_.normals[vertex++]));
      }
  }

  // Where the surface's triangles leave no direction, the plane's.
  void set_normal(std::size_t place, const Eigen::Vector3d& normal) {
    const double length = normal.norm();
    if (length > 1e-12) dressed_.normal[place] = (normal / length).cast<float>();
  }

  void add_rims() {
    mark_rims();
    // A rim may lie under several triangles where the surface folds: the one nearest to the map's level goes on from
    // it.
    std::vector<double> level(dressed_.ring.size(), 0), best(dressed_.ring.size(), 1e300);
    for (std::size_t place = 0; place < level.size(); ++place)
      if (wanted_[place]) level[place] = level_beside(place);
    for (const std::uint32_t index : around_.triangles_around(patch_, 3 + rims_)) rasterise(index, level, best);
    for (std::size_t place = 0; place < best.size(); ++place)
      if (best[place] < 1e300) dressed_.ring[place] = wanted_[place];
  }

  // wanted_: 2 or 3 for places one or two steps outside the map, diagonal steps included.
  void mark_rims() {
    wanted_.assign(dressed_.ring.size(), 0);
    std::vector<std::uint8_t> reached = dressed_.ring;
    for (int rim = 1; rim <= rims_; ++rim) {
      const std::vector<std::uint8_t> before = reached;
      visit_neighbours([&](std::size_t here, std::size_t there) {
        if (before[here] && !reached[there]) {
          reached[there] = 1;
          wanted_[there] = static_cast<std::uint8_t>(1 + rim);
        }
      });
    }
  }

  template <class Visitor>
  void visit_neighbours(const Visitor& visit) const {
    const auto columns = static_cast<std::int64_t>(dressed_.map.columns),
               rows = static_cast<std::int64_t>(dressed_.map.rows);
    for (std::int64_t row = 0; row < rows; ++row)
      for (std::int64_t column = 0; column < columns; ++column)
        for (std::int64_t r = std::max<std::int64_t>(row - 1, 0); r <= std::min(row + 1, rows - 1); ++r)
          for (std::int64_t c = std::max<std::int64_t>(column - 1, 0); c <= std::min(column + 1, columns - 1); ++c)
            visit(static_cast<std::size_t>(row * columns + column), static_cast<std::size_t>(r * columns + c));
  }

  // The elevation of the map's sample nearest to this place.
  double level_beside(std::size_t place) const {
    const auto columns = static_cast<std::int64_t>(dressed_.map.columns),
               rows = static_cast<std::int64_t>(dressed_.map.rows);
    const auto row = static_cast<std::int64_t>(place) / columns, column = static_cast<std::int64_t>(place) % columns;
    std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
    double level = 0;
    for (std::int64_t r = std::max<std::int64_t>(row - rims_, 0); r <= std::min(row + rims_, rows - 1); ++r)
      for (std::int64_t c = std::max<std::int64_t>(column - rims_, 0); c <= std::min(column + rims_, columns - 1);
           ++c) {
        const auto other = static_cast<std::size_t>(r * columns + c);
        const std::int64_t distance = (r - row) * (r - row) + (c - column) * (c - column);
        if (dressed_.ring[other] != 1 || distance >= nearest) continue;
        nearest = distance;
        level = dressed_.map.elevation[other];
      }
    return level;
  }

  void rasterise(std::uint32_t index, const std::vector<double>& level, std::vector<double>& best) {
    constexpr double kSteepest = 0.1;  // cosine to the plane's normal: 84 degrees
    const auto& triangle = around_.surface.triangles[index];
    const Eigen::Vector3d normal = scaled_normal(around_.surface, triangle);
    if (normal.dot(map_.plane.normal) < kSteepest * normal.norm()) return;
    const double spacing = around_.maps.spacing;
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = along_axes(map_.plane, around_.surface.positions[triangle[i]] - dressed_.map.plane.origin);
      corners[i].head<2>() /= spacing;
    }
    const auto columns = static_cast<std::int64_t>(dressed_.map.columns);
    rasterise_triangle(corners, [&](std::int32_t x, std::int32_t y, double height) {
      if (x < 0 || y < 0 || x >= columns || y >= static_cast<std::int64_t>(dressed_.map.rows)) return;
      const auto place = static_cast<std::size_t>(y * columns + x);
      if (!wanted_[place] || std::abs(height - level[place]) >= best[place]) return;
      best[place] = std::abs(height - level[place]);
      dressed_.map.elevation[place] = height;
      set_normal(place, interpolated_normal(triangle, corners, x, y));
    });
  }

  Eigen::Vector3d interpolated_normal(const std::array<std::uint32_t, 3>& triangle,
                                      const std::array<Eigen::Vector3d, 3>& corners, double x, double y) const {
    const Eigen::Vector2d a = corners[0].head<2>(), b = corners[1].head<2>() - a, c = corners[2].head<2>() - a;
    const Eigen::Vector2d p = Eigen::Vector2d(x, y) - a;
    const double area = b.x() * c.y() - b.y() * c.x();
    const double weight_b = (p.x() * c.y() - p.y() * c.x()) / area, weight_c = (b.x() * p.y() - b.y() * p.x()) / area;
    return along_axes(map_.plane, (1 - weight_b - weight_c) * around_.normals[triangle[0]] +
                                      weight_b * around_.normals[triangle[1]] +
                                      weight_c * around_.normals[triangle[2]]);
  }

  const Surroundings& around_;
  const ElevationPatch& map_;
  std::uint32_t patch_;
  int rims_;
  std::vector<std::uint8_t> wanted_;
  DressedPatch dressed_;
};

}  // namespace

std::vector<DressedPatch> dressed_patches(const ElevationMaps& maps, const Mesh& surface, int rims) {
  assert(rims >= 0 && rims <= kMostRims);
  const Surroundings around(maps, surface);
  std::vector<DressedPatch> dressed(maps.patches.size());
  thin::parallel_ranges(maps.patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) dressed[i] = Dresser(around, static_cast<std::uint32_t>(i), rims).run();
  });
  return dressed;
}

}  // namespace emap
