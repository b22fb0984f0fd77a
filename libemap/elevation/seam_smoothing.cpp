#include "libemap/elevation/seam_smoothing.h"

#include <algorithm>
#include <cmath>

#include "libemap/elevation/cube_hash.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/map_grid.h"
#include "libemap/elevation/resampling.h"
#include "libemap/surface/boundary_edges.h"
#include "libemap/surface/mesh_normals.h"
#include "libemap/surface/triangle_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Eigen::Vector3d;

constexpr double kLeastLead = 1.02;  // of another patch over one's own, so that nothing swings to and fro
constexpr double kFacing = 0.15;     // least cosine to the new patch's plane
constexpr double kOtherSheet = 4;    // spacings of height

class SeamSmoothing {
 public:
  SeamSmoothing(const Mesh& mesh, const TriangleNeighbours& neighbours, std::vector<std::uint32_t> patch_of,
                const ElevationMaps& maps, const SeamSmoothingOptions& options)
      : neighbours_(neighbours), patch_of_(std::move(patch_of)), maps_(maps), options_(options) {
    for (const auto& triangle : mesh.triangles) {
      centres_.push_back((mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) / 3);
      normals_.push_back(scaled_normal(mesh, triangle));
      areas_.push_back(normals_.back().norm());
    }
  }

  std::vector<std::uint32_t> run() {
    for (int round = 0; round < options_.rounds; ++round) {
      const std::vector<std::uint32_t> band = triangles_at_seams();
      std::vector<std::uint32_t> chosen(band.size());
      thin::parallel_ranges(band.size(), 2048, [&](std::size_t begin, std::size_t end) {
        Surroundings surroundings{{}, std::vector<std::uint32_t>(patch_of_.size(), kNoTriangle), {}};
        for (std::size_t i = begin; i < end; ++i) chosen[i] = best_patch(band[i], surroundings);
      });
      bool any = false;
      for (std::size_t i = 0; i < band.size(); ++i) {
        any = any || patch_of_[band[i]] != chosen[i];
        patch_of_[band[i]] = chosen[i];
      }
      if (!any) break;
    }
    return std::move(patch_of_);
  }

 private:
  struct Vote {
    std::uint32_t patch;
    double weight;
  };
  struct Surroundings {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> reached_from;  // of each triangle of the mesh: the last one around which it was found
    std::vector<Vote> votes;
  };

  // Those with a neighbour in another patch, and their neighbours.
  std::vector<std::uint32_t> triangles_at_seams() const {
    std::vector<std::uint8_t> is_near(patch_of_.size());
    for (std::uint32_t i = 0; i < patch_of_.size(); ++i)
      for (const std::uint32_t other : neighbours_[i])
        if (other != kNoTriangle && patch_of_[other] != patch_of_[i]) {
          is_near[i] = 1;
          for (const std::uint32_t next : neighbours_[i])
            if (next != kNoTriangle) is_near[next] = 1;
        }
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < is_near.size(); ++i)
      if (is_near[i]) found.push_back(i);
    return found;
  }

  std::uint32_t best_patch(std::uint32_t triangle, Surroundings& around) const {
    vote(triangle, around);
    std::uint32_t best = patch_of_[triangle];
    double most = 0;
    for (const Vote& vote : around.votes)
      if (vote.patch == best) most = kLeastLead * vote.weight;
    for (const Vote& vote : around.votes)
      if (vote.weight > most && may_change(triangle, vote.patch)) {
        most = vote.weight;
        best = vote.patch;
      }
    return best;
  }

  // The areas of the patches around, near ones more, as far as the surface goes on without a crease.
  void vote(std::uint32_t triangle, Surroundings& around) const {
    const double reach = options_.reach * maps_.spacing;
    around.votes.clear();
    around.triangles.assign(1, triangle);
    around.reached_from[triangle] = triangle;
    for (std::size_t next = 0; next < around.triangles.size(); ++next) {
      const std::uint32_t at = around.triangles[next];
      const double weight = areas_[at] * (1 - (centres_[at] - centres_[triangle]).squaredNorm() / (reach * reach));
      const auto same = std::find_if(around.votes.begin(), around.votes.end(),
                                     [&](const Vote& vote) { return vote.patch == patch_of_[at]; });
      if (same == around.votes.end())
        around.votes.push_back({patch_of_[at], weight});
      else
        same->weight += weight;
      for (const std::uint32_t other : neighbours_[at]) {
        if (other == kNoTriangle || around.reached_from[other] == triangle) continue;
        if ((centres_[other] - centres_[triangle]).squaredNorm() >= reach * reach) continue;
        if (cosine(other, triangle) <= options_.crease_cosine) continue;
        around.reached_from[other] = triangle;
        around.triangles.push_back(other);
      }
    }
  }

  double cosine(std::uint32_t a, std::uint32_t b) const {
    const double areas = areas_[a] * areas_[b];
    return areas > 0 ? normals_[a].dot(normals_[b]) / areas : 1;
  }
  double cosine_to_plane(std::uint32_t triangle, std::uint32_t patch) const {
    if (!(areas_[triangle] > 0)) return 1;
    return normals_[triangle].dot(maps_.patches[patch].plane.normal) / areas_[triangle];
  }

  bool may_change(std::uint32_t triangle, std::uint32_t patch) const {
    const double after = cosine_to_plane(triangle, patch);
    if (after <= kFacing) return false;
    if (after < options_.steepest_cosine && after < cosine_to_plane(triangle, patch_of_[triangle])) return false;
    return !lies_over_another_sheet(triangle, maps_.patches[patch]);
  }

  bool lies_over_another_sheet(std::uint32_t triangle, const ElevationPatch& patch) const {
    const Vector3d place = over_plane(patch.plane, maps_.spacing, centres_[triangle]);
    const auto column = static_cast<std::int64_t>(std::lround(place.x()));
    const auto row = static_cast<std::int64_t>(std::lround(place.y()));
    for (std::int64_t r = row - 1; r <= row + 1; ++r)
      for (std::int64_t c = column - 1; c <= column + 1; ++c) {
        if (r < 0 || c < 0 || r >= patch.rows || c >= patch.columns) continue;
        const auto sample = static_cast<std::size_t>(r * patch.columns + c);
        if (patch.mask[sample] && std::abs(patch.elevation[sample] - place.z()) > kOtherSheet * maps_.spacing)
          return true;
      }
    return false;
  }

  const TriangleNeighbours& neighbours_;
  std::vector<std::uint32_t> patch_of_;
  const ElevationMaps& maps_;
  const SeamSmoothingOptions& options_;
  std::vector<Vector3d> centres_, normals_;  // normals as long as areas_
  std::vector<double> areas_;                // doubled
};

// Triangles near places that the closed maps miss go back to the patches that they were given to. Whether any did.
bool restore_at_holes(const Mesh& mesh, const Partition& given, const ElevationMaps& maps, double hole, double reach,
                      std::vector<std::uint32_t>& patch_of) {
  const TriangleTree surface(closed_mesh(maps).mesh);
  const std::vector<Vector3d> seams = vertices_on_seams(mesh, patch_of);
  std::vector<std::uint8_t> is_hole(seams.size());
  thin::parallel_ranges(seams.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      is_hole[i] = surface.closest(seams[i]).distance_squared > hole * hole * maps.spacing * maps.spacing;
  });
  const double around = reach * maps.spacing;
  CubeHash holes(around);
  for (std::uint32_t i = 0; i < seams.size(); ++i)
    if (is_hole[i]) holes.add(i, seams[i], seams[i]);
  bool any = false;
  for (std::size_t i = 0; i < patch_of.size(); ++i) {
    if (patch_of[i] == given.patch_of[i]) continue;
    const Vector3d& corner = mesh.positions[mesh.triangles[i][0]];
    bool is_near = false;
    holes.visit(corner.array() - around, corner.array() + around,
                [&](std::uint32_t seam) { is_near = is_near || (seams[seam] - corner).norm() < around; });
    if (is_near) patch_of[i] = given.patch_of[i];
    any = any || is_near;
  }
  return any;
}

}  // namespace

TriangleNeighbours triangle_neighbours(const Mesh& mesh) {
  TriangleNeighbours neighbours(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  const auto add = [&](std::uint32_t triangle, std::uint32_t other) {
    const auto free = std::find(neighbours[triangle].begin(), neighbours[triangle].end(), kNoTriangle);
    if (free != neighbours[triangle].end()) *free = other;
  };
  for (const EdgePair& pair : edge_pairs(mesh)) {
    add(pair.first_triangle, pair.second_triangle);
    add(pair.second_triangle, pair.first_triangle);
  }
  return neighbours;
}

std::vector<std::uint32_t> smooth_seams(const Mesh& mesh, const TriangleNeighbours& neighbours,
                                        const Partition& partition, const ElevationMaps& maps,
                                        const SeamSmoothingOptions& options) {
  return SeamSmoothing(mesh, neighbours, partition.patch_of, maps, options).run();
}

std::vector<Vector3d> vertices_on_seams(const Mesh& mesh, const std::vector<std::uint32_t>& patch_of) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF, kSeam = kNone - 1;
  std::vector<std::uint32_t> patch_of_vertex(mesh.positions.size(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      std::uint32_t& patch = patch_of_vertex[vertex];
      patch = patch == kNone || patch == patch_of[i] ? patch_of[i] : kSeam;
    }
  std::vector<Vector3d> seams;
  for (std::size_t i = 0; i < patch_of_vertex.size(); ++i)
    if (patch_of_vertex[i] == kSeam) seams.push_back(mesh.positions[i]);
  return seams;
}

SmoothlyCut resample_with_smooth_seams(const Mesh& mesh, const TriangleNeighbours& neighbours,
                                       const Partition& partition, std::span<const BasePlane> planes, double spacing,
                                       const SeamSmoothingOptions& options) {
  SmoothlyCut result{partition, resample_mesh(mesh, partition, planes, spacing)};
  result.partition.patch_of = smooth_seams(mesh, neighbours, partition, result.maps, options);
  result.maps = resample_mesh(mesh, result.partition, planes, spacing);
  if (restore_at_holes(mesh, partition, result.maps, options.hole, options.reach, result.partition.patch_of))
    result.maps = resample_mesh(mesh, result.partition, planes, spacing);
  return result;
}

}  // namespace emap
