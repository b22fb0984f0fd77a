#include "libemap/elevation/gap_filling.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <unordered_set>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/cube_hash.h"
#include "libemap/elevation/triangle_crossing.h"
#include "libemap/surface/boundary_edges.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr std::size_t kCandidatesPerEdge = 12;
constexpr double kLongestSide = 4;      // in spacings, of an edge by which the reach grows
constexpr double kSharpestFold = -0.7;  // cosine between the normals of neighbouring triangles
constexpr double kLeastHeight = 1e-3;   // of a triangle, in lengths of its longest side

struct Candidate {
  double score;
  std::uint32_t from, to;  // boundary edge, in the direction of its triangle
  std::uint32_t tip;
  double reach;

  // For a queue that hands out the least score first; ties by the vertices.
  bool operator<(const Candidate& other) const {
    return std::tie(other.score, other.from, other.to, other.tip) < std::tie(score, from, to, tip);
  }
};

class GapFiller {
 public:
  GapFiller(double spacing, std::span<const std::uint32_t> patch_of_vertex, Mesh& mesh,
            const GapFillingOptions& options)
      : spacing_(spacing),
        patch_of_vertex_(patch_of_vertex),
        mesh_(mesh),
        options_(options),
        boundary_degree_(mesh.positions.size(), 0),
        vertices_(2 * spacing),
        surroundings_(2 * spacing),
        triangles_(2 * spacing) {}

  GapFilling run() {
    const std::vector<BoundaryEdge> boundary = boundary_edges(mesh_);
    GapFilling result;
    result.edges_before = boundary.size();
    file_vertices(boundary);
    file_surroundings(boundary);
    const std::size_t triangles_before = mesh_.triangles.size();
    for (const BoundaryEdge& edge : boundary)
      propose(edge.from, edge.to, edge.opposite, reach_of((at(edge.from) - at(edge.to)).norm()));
    insert_best_first();
    within_small_holes_ = true;
    for (const BoundaryEdge& edge : edges_of_small_holes())
      propose(edge.from, edge.to, edge.opposite, reach_of((at(edge.from) - at(edge.to)).norm()));
    insert_best_first();
    result.inserted = mesh_.triangles.size() - triangles_before;
    result.edges_left = open_edges_;
    return result;
  }

 private:
  void insert_best_first() {
    while (!candidates_.empty()) {
      const Candidate candidate = candidates_.top();
      candidates_.pop();
      if (is_open(candidate) && fits(candidate)) insert(candidate);
    }
  }

  static std::uint64_t directed(std::uint32_t from, std::uint32_t to) { return (std::uint64_t{from} << 32) | to; }
  bool is_used(std::uint32_t from, std::uint32_t to) const { return used_.contains(directed(from, to)); }
  bool is_boundary(std::uint32_t from, std::uint32_t to) const { return is_used(from, to) && !is_used(to, from); }
  const Eigen::Vector3d& at(std::uint32_t vertex) const { return mesh_.positions[vertex]; }

  void file_vertices(const std::vector<BoundaryEdge>& boundary) {
    open_edges_ = boundary.size();
    for (const BoundaryEdge& edge : boundary)
      for (const std::uint32_t vertex : {edge.from, edge.to})
        if (boundary_degree_[vertex]++ == 0) vertices_.add(vertex, at(vertex), at(vertex));
  }

  // Triangles within reach of the boundary, and the sides of those at boundary vertices. The others can't be crossed by
  // what is inserted, for that stays within the cubes that are looked through here; nor can their sides be taken twice.
  void file_surroundings(const std::vector<BoundaryEdge>& boundary) {
    for (const BoundaryEdge& edge : boundary) {
      const double reach =
          std::max(options_.small_hole_reach * spacing_, reach_of((at(edge.from) - at(edge.to)).norm()));
      surroundings_.mark(at(edge.from).cwiseMin(at(edge.to)).array() - reach,
                         at(edge.from).cwiseMax(at(edge.to)).array() + reach);
    }
    std::vector<std::uint8_t> is_near(mesh_.triangles.size());
    thin::parallel_ranges(is_near.size(), 8192, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto [low, high] = box_of(mesh_.triangles[i]);
        is_near[i] = surroundings_.touches(low, high);
      }
    });
    used_.reserve(8 * boundary.size());
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (!is_near[i]) continue;  // as are all at boundary vertices
      const Triangle& triangle = mesh_.triangles[i];
      const auto [low, high] = box_of(triangle);
      triangles_.add_where(surroundings_, i, low, high);
      for (std::size_t corner = 0; corner < 3; ++corner)
        if (boundary_degree_[triangle[corner]] > 0 && boundary_degree_[triangle[(corner + 1) % 3]] > 0)
          used_.insert(directed(triangle[corner], triangle[(corner + 1) % 3]));
    }
  }

  // On steep slopes samples, and gaps, are wider than the spacing.
  double reach_of(double side) const {
    return (within_small_holes_ ? options_.small_hole_reach : options_.reach) *
           std::max(spacing_, std::min(side, kLongestSide * spacing_) / 2);
  }

  std::pair<Eigen::Vector3d, Eigen::Vector3d> box_of(const Triangle& triangle) const {
    return {at(triangle[0]).cwiseMin(at(triangle[1])).cwiseMin(at(triangle[2])),
            at(triangle[0]).cwiseMax(at(triangle[1])).cwiseMax(at(triangle[2]))};
  }

  Eigen::Vector3d normal_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (at(b) - at(a)).cross(at(c) - at(a)).normalized();
  }

  // The best tips for triangles on the free side of the edge into the queue. opposite: the third corner of the triangle
  // that it bounds. reach: of the triangle's sides; not of the edge's own length, or wide holes would close step by
  // step.
  void propose(std::uint32_t from, std::uint32_t to, std::uint32_t opposite, double reach) {
    const Eigen::Vector3d middle = (at(from) + at(to)) / 2;
    const Eigen::Vector3d normal = normal_of(from, to, opposite);
    found_.clear();
    vertices_.visit(middle.array() - reach, middle.array() + reach, [&](std::uint32_t tip) {
      if (tip == from || tip == to || boundary_degree_[tip] == 0) return;
      const double score = score_of(from, to, tip, normal, reach);
      if (std::isfinite(score)) found_.push_back({score, from, to, tip, reach});
    });
    const auto best_first = [](const Candidate& a, const Candidate& b) { return b < a; };
    const std::size_t kept = std::min(kCandidatesPerEdge, found_.size());
    std::partial_sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(kept), found_.end(), best_first);
    for (std::size_t i = 0; i < kept; ++i) candidates_.push(found_[i]);
  }

  // Small where the triangle is small and goes on flat; infinite where it is out of reach, folds back or is a line.
  double score_of(std::uint32_t from, std::uint32_t to, std::uint32_t tip, const Eigen::Vector3d& normal,
                  double reach) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double from_squared = (at(tip) - at(from)).squaredNorm(), to_squared = (at(tip) - at(to)).squaredNorm();
    const double side_squared = (at(from) - at(to)).squaredNorm();
    const double longest_squared = std::max({from_squared, to_squared, side_squared});
    if (!may_join(from, tip, from_squared, reach) || !may_join(tip, to, to_squared, reach)) return kNever;
    const Eigen::Vector3d scaled_normal = (at(from) - at(to)).cross(at(tip) - at(to));
    const double length = scaled_normal.norm();
    if (!(length > kLeastHeight * longest_squared)) return kNever;
    const double cosine = normal.dot(scaled_normal) / length;
    if (cosine < kSharpestFold) return kNever;
    return (from_squared + to_squared) * (2 - cosine);
  }

  // Sides that are there already may be of any length.
  bool may_join(std::uint32_t from, std::uint32_t to, double length_squared, double reach) const {
    const bool within =
        !within_small_holes_ && !patch_of_vertex_.empty() && patch_of_vertex_[from] == patch_of_vertex_[to];
    const double longest = within ? reach * options_.reach_within / options_.reach : reach;
    return length_squared <= longest * longest || is_used(to, from);
  }

  // The open edges on loops that are short enough.
  std::vector<BoundaryEdge> edges_of_small_holes() const {
    std::unordered_map<std::uint32_t, std::vector<BoundaryEdge>> leaving;  // open edges by where they come from
    std::vector<BoundaryEdge> open = boundary_edges(mesh_), small;
    for (const BoundaryEdge& edge : open) leaving[edge.from].push_back(edge);
    for (const BoundaryEdge& edge : open) {
      std::uint32_t vertex = edge.to;
      std::size_t edges = 1;
      // Where loops meet at a vertex, either may be followed: the count then decides about both.
      for (; vertex != edge.from && edges <= options_.small_hole_edges; ++edges) {
        const auto next = leaving.find(vertex);
        if (next == leaving.end()) break;
        vertex = next->second.front().to;
      }
      if (vertex == edge.from && edges <= options_.small_hole_edges) small.push_back(edge);
    }
    return small;
  }

  bool is_open(const Candidate& candidate) const {
    return is_boundary(candidate.from, candidate.to) && boundary_degree_[candidate.tip] > 0 &&
           !is_used(candidate.from, candidate.tip) && !is_used(candidate.tip, candidate.to);
  }

  bool fits(const Candidate& candidate) {
    const Triangle triangle = {candidate.to, candidate.from, candidate.tip};
    const auto [low, high] = box_of(triangle);
    if (!surroundings_.covers(low, high)) return false;
    bool crosses = false;
    triangles_.visit(low, high, [&, low = low, high = high](std::uint32_t other) {
      if (crosses) return;
      const auto [other_low, other_high] = box_of(mesh_.triangles[other]);
      if ((other_low.array() > high.array()).any() || (other_high.array() < low.array()).any()) return;
      crosses = triangles_cross(mesh_.positions, triangle, mesh_.triangles[other]);
    });
    return !crosses;
  }

  void insert(const Candidate& candidate) {
    const Triangle triangle = {candidate.to, candidate.from, candidate.tip};
    const auto [low, high] = box_of(triangle);
    triangles_.add(static_cast<std::uint32_t>(mesh_.triangles.size()), low, high);
    mesh_.triangles.push_back(triangle);
    take_side(candidate.to, candidate.from);
    take_side(candidate.from, candidate.tip);
    take_side(candidate.tip, candidate.to);
    if (is_boundary(candidate.from, candidate.tip))
      propose(candidate.from, candidate.tip, candidate.to, candidate.reach);
    if (is_boundary(candidate.tip, candidate.to)) propose(candidate.tip, candidate.to, candidate.from, candidate.reach);
  }

  // The side gets its triangle: it closes an open edge, or opens one.
  void take_side(std::uint32_t from, std::uint32_t to) {
    used_.insert(directed(from, to));
    const bool closes = is_used(to, from);
    for (const std::uint32_t vertex : {from, to}) closes ? --boundary_degree_[vertex] : ++boundary_degree_[vertex];
    closes ? --open_edges_ : ++open_edges_;
  }

  double spacing_;
  std::span<const std::uint32_t> patch_of_vertex_;
  Mesh& mesh_;
  const GapFillingOptions& options_;
  std::vector<std::uint32_t> boundary_degree_;    // boundary edges at each vertex
  CubeHash vertices_, surroundings_, triangles_;  // boundary vertices; cubes around them, and the triangles in these
  std::unordered_set<std::uint64_t> used_;        // directed sides between boundary vertices that have a triangle
  std::priority_queue<Candidate> candidates_;
  std::vector<Candidate> found_;
  std::size_t open_edges_ = 0;
  bool within_small_holes_ = false;
};

}  // namespace

GapFilling fill_gaps(double spacing, std::span<const std::uint32_t> patch_of_vertex, Mesh& mesh,
                     const GapFillingOptions& options) {
  assert(patch_of_vertex.empty() || patch_of_vertex.size() == mesh.positions.size());
  return GapFiller(spacing, patch_of_vertex, mesh, options).run();
}

ClosedMesh closed_mesh(const ElevationMaps& maps, const GapFillingOptions& options) {
  ClosedMesh closed{canonical_mesh(maps), {}};
  closed.filling = fill_gaps(maps.spacing, patches_of_samples(maps), closed.mesh, options);
  return closed;
}

}  // namespace emap
