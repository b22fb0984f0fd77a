#include "libemap/coding/surface_to_encode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/coding/mask_choice.h"
#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
#include "libemap/elevation/seam_smoothing.h"
#include "libemap/surface/mesh_repair.h"
#include "libemap/surface/mls_surface.h"
#include "libemap/surface/point_mesh.h"
#include "libemap/surface/point_normals.h"
#include "libemap/surface/surface_samples.h"
#include "libemap/surface/triangle_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Eigen::Vector3d;
using thin::Result;
using Made = std::unique_ptr<SurfaceToEncode>;

constexpr double kCleanShare = 0.97;  // of a point set's points that are used by the mesh through them

// Triangles of a surface that are sampled one by one; where it has more, as runs of neighbours.
constexpr std::size_t kMostSingleTriangles = 1000000;

constexpr std::size_t kQuickStride = 4;  // of the samples that are used for a quick look

WeightedSamples every_nth(const WeightedSamples& samples, std::size_t n) {
  WeightedSamples result;
  for (std::size_t i = n / 2; i < samples.positions.size(); i += n) {
    result.positions.push_back(samples.positions[i]);
    result.areas.push_back(samples.areas[i]);
  }
  return result;
}

double root_mean_square_distance(const WeightedSamples& samples, const TriangleTree& tree) {
  if (samples.positions.empty()) return std::numeric_limits<double>::infinity();
  const std::vector<double> squared = tree.distances_squared(samples.positions);
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < squared.size(); ++i) {
    sum += samples.areas[i] * squared[i];
    area += samples.areas[i];
  }
  return std::sqrt(sum / area);
}

// Of the points, those that some triangle uses.
double share_of_points_used(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) used[vertex] = 1;
  return static_cast<double>(std::count(used.begin(), used.end(), 1)) / static_cast<double>(used.size());
}

// A mesh through the points as they are. Where many of them find no place in it, they are noisy or several scans of the
// same surface: then through their projections onto the MLS surface.
Mesh mesh_standing_for(PointSet& points) {
  Mesh mesh = mesh_of_points(points);
  if (share_of_points_used(mesh) >= kCleanShare) return mesh;
  const MlsSurface surface(points.positions);
  thin::parallel_ranges(points.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points.positions[i] = surface.project(points.positions[i]).position;
  });
  return mesh_of_points(points);
}

// What all partitions of a surface share: its mesh, and what decoded ones are measured by.
struct MeasuredMesh {
  MeasuredMesh(Mesh given, std::size_t given_points, const BoundingBox& given_box, bool from_points,
               std::size_t samples_wanted)
      : mesh(std::move(given)),
        point_count(given_points),
        box(given_box),
        is_points(from_points),
        tree(mesh),
        neighbours(triangle_neighbours(mesh)),
        sample_count(samples_wanted),
        samples(sample_every_part(mesh, samples_wanted,
                                  mesh.triangles.size() > kMostSingleTriangles ? mesh.triangles.size() : 0, 1)),
        quick_samples(every_nth(samples, kQuickStride)) {}

  Mesh mesh;
  std::size_t point_count;  // of what was given
  BoundingBox box;
  bool is_points;
  TriangleTree tree;
  TriangleNeighbours neighbours;
  std::size_t sample_count;
  WeightedSamples samples, quick_samples;
};

class PartitionedMesh : public SurfaceToEncode {
 public:
  PartitionedMesh(std::shared_ptr<const MeasuredMesh> measured, Partition partition)
      : measured_(std::move(measured)),
        partition_(std::move(partition)),
        planes_(base_planes(measured_->mesh, partition_)),
        elements_(partition_.elements_of_patches()) {}

  static Result<Made> made(std::shared_ptr<const MeasuredMesh> measured, const PartitionOptions& options) {
    Result<Partition> partition = partition_mesh(measured->mesh, options);
    if (!partition) return partition.error();
    return Made(std::make_unique<PartitionedMesh>(std::move(measured), std::move(*partition)));
  }

  bool is_points() const override { return measured_->is_points; }
  std::size_t point_count() const override { return measured_->point_count; }
  const BoundingBox& box() const override { return measured_->box; }
  const std::vector<BasePlane>& planes() const override { return planes_; }

  std::vector<Vector3d> positions_of(std::size_t patch) const override {
    std::vector<Vector3d> positions;
    positions.reserve(3 * elements_[patch].size());
    for (const std::uint32_t triangle : elements_[patch])
      for (const std::uint32_t vertex : measured_->mesh.triangles[triangle])
        positions.push_back(measured_->mesh.positions[vertex]);
    return positions;
  }

  ElevationMaps resample(std::span<const BasePlane> planes, double spacing, MaskEffort effort) const override {
    const Mesh& mesh = measured_->mesh;
    if (effort == MaskEffort::none) return resample_mesh(mesh, partition_, planes, spacing);
    SmoothlyCut cut = effort == MaskEffort::seams
                          ? resample_with_smooth_seams(mesh, measured_->neighbours, partition_, planes, spacing)
                          : SmoothlyCut{partition_, resample_mesh(mesh, partition_, planes, spacing)};
    choose_cheaper_masks(mesh, cut.partition, measured_->tree, cut.maps);
    return std::move(cut.maps);
  }

  double error_of(const ElevationMaps& decoded, bool quick) const override {
    const auto [mesh, filling] = closed_mesh(decoded);
    if (mesh.triangles.empty()) return std::numeric_limits<double>::infinity();
    const double missing =
        root_mean_square_distance(quick ? measured_->quick_samples : measured_->samples, TriangleTree(mesh));
    // What fills gaps is where a decoded surface may be wrong in ways that are rare: looked at triangle by triangle.
    const WeightedSamples samples =
        quick ? sample_every_part(mesh, measured_->sample_count / kQuickStride, mesh.triangles.size(), 2)
              : sample_every_part(mesh, measured_->sample_count, mesh.triangles.size() - filling.inserted, 2);
    return std::max(missing, root_mean_square_distance(samples, measured_->tree));
  }

  Result<Made> repartitioned(const PartitionOptions& options) const override { return made(measured_, options); }

 private:
  std::shared_ptr<const MeasuredMesh> measured_;
  Partition partition_;
  std::vector<BasePlane> planes_;
  std::vector<std::vector<std::uint32_t>> elements_;
};

Result<Made> partitioned(Mesh mesh, std::size_t point_count, const BoundingBox& box, bool is_points,
                         const PartitionOptions& options, std::size_t samples) {
  if (mesh.triangles.empty())
    return thin::Error{thin::ErrorKind::input, is_points
                                                   ? "the points lie on a line or too far apart to make a surface"
                                                   : "the mesh has no triangles to make patches of; read it as points"};
  return PartitionedMesh::made(
      std::make_shared<const MeasuredMesh>(std::move(mesh), point_count, box, is_points, samples), options);
}

}  // namespace

Result<std::unique_ptr<SurfaceToEncode>> mesh_to_encode(Mesh mesh, const PartitionOptions& options,
                                                        std::size_t samples) {
  const std::size_t point_count = mesh.positions.size();
  mesh = weld_vertices(mesh);
  orient_consistently(mesh);
  const BoundingBox box = bounding_box(mesh.positions);
  return partitioned(std::move(mesh), point_count, box, false, options, samples);
}

Result<std::unique_ptr<SurfaceToEncode>> points_to_encode(PointSet points, const PartitionOptions& options,
                                                          std::size_t samples) {
  if (points.positions.size() < 3)
    return thin::Error{thin::ErrorKind::input, "fewer than three points make no surface"};
  ensure_normals(points);
  const BoundingBox box = bounding_box(points.positions);
  Mesh mesh = mesh_standing_for(points);
  return partitioned(std::move(mesh), points.positions.size(), box, true, options, samples);
}

}  // namespace emap
