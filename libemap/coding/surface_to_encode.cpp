#include "libemap/coding/surface_to_encode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
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

// A partitioned mesh, and the surface that decoded ones are measured against.
class PartitionedMesh : public SurfaceToEncode {
 public:
  struct Content {
    Mesh mesh;
    Partition partition;
    std::vector<BasePlane> planes;
    BoundingBox box;
    bool is_points = false;
    std::size_t point_count = 0;
  };

  PartitionedMesh(Content content, const Mesh& measured, std::size_t samples)
      : content_(std::move(content)),
        elements_(content_.partition.elements_of_patches()),
        tree_(measured),
        samples_(sample_surface(measured, samples, 1)) {}

  bool is_points() const override { return content_.is_points; }
  std::size_t point_count() const override { return content_.point_count; }
  const BoundingBox& box() const override { return content_.box; }
  const std::vector<BasePlane>& planes() const override { return content_.planes; }

  std::vector<Vector3d> positions_of(std::size_t patch) const override {
    std::vector<Vector3d> positions;
    positions.reserve(3 * elements_[patch].size());
    for (const std::uint32_t triangle : elements_[patch])
      for (const std::uint32_t vertex : content_.mesh.triangles[triangle])
        positions.push_back(content_.mesh.positions[vertex]);
    return positions;
  }

  ElevationMaps resample(std::span<const BasePlane> planes, double spacing) const override {
    return resample_mesh(content_.mesh, content_.partition, planes, spacing);
  }

  double error_of(const ElevationMaps& decoded) const override {
    const Mesh mesh = closed_mesh(decoded).mesh;
    if (mesh.triangles.empty()) return std::numeric_limits<double>::infinity();
    const double missing = root_mean_square_distance(samples_, TriangleTree(mesh));
    return std::max(missing, root_mean_square_distance(sample_surface(mesh, samples_.size(), 2), tree_));
  }

 private:
  Content content_;
  std::vector<std::vector<std::uint32_t>> elements_;
  TriangleTree tree_;
  std::vector<Vector3d> samples_;
};

}  // namespace

Result<std::unique_ptr<SurfaceToEncode>> mesh_to_encode(Mesh mesh, const PartitionOptions& options,
                                                        std::size_t samples) {
  Result<Partition> partition = partition_mesh(mesh, options);
  if (!partition) return partition.error();
  std::vector<BasePlane> planes = base_planes(mesh, *partition);
  const BoundingBox box = bounding_box(mesh.positions);
  const std::size_t count = mesh.positions.size();
  const Mesh measured = mesh;
  return Made(std::make_unique<PartitionedMesh>(
      PartitionedMesh::Content{std::move(mesh), std::move(*partition), std::move(planes), box, false, count}, measured,
      samples));
}

Result<std::unique_ptr<SurfaceToEncode>> points_to_encode(PointSet points, const PartitionOptions& options,
                                                          std::size_t samples) {
  if (points.positions.size() < 3)
    return thin::Error{thin::ErrorKind::input, "fewer than three points make no surface"};
  ensure_normals(points);
  const BoundingBox box = bounding_box(points.positions);
  const std::size_t count = points.positions.size();
  Mesh mesh = mesh_standing_for(points);
  if (mesh.triangles.empty())
    return thin::Error{thin::ErrorKind::input, "the points lie on a line or too far apart to make a surface"};
  Result<Partition> partition = partition_mesh(mesh, options);
  if (!partition) return partition.error();
  std::vector<BasePlane> planes = base_planes(mesh, *partition);
  const Mesh measured = mesh;
  return Made(std::make_unique<PartitionedMesh>(
      PartitionedMesh::Content{std::move(mesh), std::move(*partition), std::move(planes), box, true, count}, measured,
      samples));
}

}  // namespace emap
