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

double root_mean_square_distance(const std::vector<Vector3d>& points, const TriangleTree& tree) {
  if (points.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> squared(points.size());
  thin::parallel_ranges(points.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) squared[i] = tree.closest(points[i]).distance_squared;
  });
  double sum = 0;
  for (const double value : squared) sum += value;
  return std::sqrt(sum / static_cast<double>(points.size()));
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
  MeasuredMesh(Mesh given, const BoundingBox& given_box, bool from_points, std::size_t samples_wanted)
      : mesh(std::move(given)),
        box(given_box),
        is_points(from_points),
        tree(mesh),
        neighbours(triangle_neighbours(mesh)),
        samples(sample_surface(mesh, samples_wanted, 1)) {}

  Mesh mesh;
  BoundingBox box;
  bool is_points;
  TriangleTree tree;
  TriangleNeighbours neighbours;
  std::vector<Vector3d> samples;
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
  std::size_t point_count() const override { return measured_->mesh.positions.size(); }
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

  double error_of(const ElevationMaps& decoded) const override {
    const Mesh mesh = closed_mesh(decoded).mesh;
    if (mesh.triangles.empty()) return std::numeric_limits<double>::infinity();
    const std::vector<Vector3d>& samples = measured_->samples;
    const double missing = root_mean_square_distance(samples, TriangleTree(mesh));
    return std::max(missing, root_mean_square_distance(sample_surface(mesh, samples.size(), 2), measured_->tree));
  }

  Result<Made> repartitioned(const PartitionOptions& options) const override { return made(measured_, options); }

 private:
  std::shared_ptr<const MeasuredMesh> measured_;
  Partition partition_;
  std::vector<BasePlane> planes_;
  std::vector<std::vector<std::uint32_t>> elements_;
};

Result<Made> partitioned(Mesh mesh, const BoundingBox& box, bool is_points, const PartitionOptions& options,
                         std::size_t samples) {
  if (mesh.triangles.empty())
    return thin::Error{thin::ErrorKind::input, is_points
                                                   ? "the points lie on a line or too far apart to make a surface"
                                                   : "the mesh has no triangles to make patches of; read it as points"};
  return PartitionedMesh::made(std::make_shared<const MeasuredMesh>(std::move(mesh), box, is_points, samples), options);
}

}  // namespace

Result<std::unique_ptr<SurfaceToEncode>> mesh_to_encode(Mesh mesh, const PartitionOptions& options,
                                                        std::size_t samples) {
  const BoundingBox box = bounding_box(mesh.positions);
  return partitioned(std::move(mesh), box, false, options, samples);
}

Result<std::unique_ptr<SurfaceToEncode>> points_to_encode(PointSet points, const PartitionOptions& options,
                                                          std::size_t samples) {
  if (points.positions.size() < 3)
    return thin::Error{thin::ErrorKind::input, "fewer than three points make no surface"};
  ensure_normals(points);
  const BoundingBox box = bounding_box(points.positions);
  return partitioned(mesh_standing_for(points), box, true, options, samples);
}

}  // namespace emap
