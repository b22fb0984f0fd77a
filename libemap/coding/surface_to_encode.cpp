#include "libemap/coding/surface_to_encode.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
#include "libemap/surface/mls_surface.h"
#include "libemap/surface/point_normals.h"
#include "libemap/surface/surface_samples.h"
#include "libemap/surface/triangle_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Eigen::Vector3d;
using thin::Result;
using Made = std::unique_ptr<SurfaceToEncode>;

constexpr std::size_t kPointSamples = 20000;  // projections onto MLS surfaces cost more
constexpr double kPointSpacings = 0.6;        // of the dense mesh that stands for a point set's MLS surface

// About `count` of the points, evenly through their order.
std::vector<Vector3d> every(const std::vector<Vector3d>& points, std::size_t count) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / count);
  std::vector<Vector3d> chosen;
  for (std::size_t i = 0; i < points.size(); i += stride) chosen.push_back(points[i]);
  return chosen;
}

double root_mean_square(const std::vector<Vector3d>& points,
                        const std::function<double(const Vector3d&)>& distance_squared) {
  if (points.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> squared(points.size());
  thin::parallel_ranges(points.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) squared[i] = distance_squared(points[i]);
  });
  double sum = 0;
  for (const double value : squared) sum += value;
  return std::sqrt(sum / static_cast<double>(points.size()));
}

double root_mean_square_distance(const std::vector<Vector3d>& points, const TriangleTree& tree) {
  return root_mean_square(points, [&](const Vector3d& p) { return tree.closest(p).distance_squared; });
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
    return content_.is_points ? error_of_points(sample_points(decoded)) : error_of_mesh(closed_mesh(decoded).mesh);
  }

 private:
  double error_of_mesh(const Mesh& decoded) const {
    if (decoded.triangles.empty()) return std::numeric_limits<double>::infinity();
    const double missing = root_mean_square_distance(samples_, TriangleTree(decoded));
    return std::max(missing, root_mean_square_distance(sample_surface(decoded, samples_.size(), 2), tree_));
  }

  // Decoded points are compared as the MLS surface that they stand for.
  double error_of_points(const PointSet& decoded) const {
    if (decoded.positions.size() < 3) return std::numeric_limits<double>::infinity();
    const MlsSurface surface(decoded.positions);
    const std::vector<Vector3d> samples = every(samples_, kPointSamples);
    const double missing =
        root_mean_square(samples, [&](const Vector3d& p) { return (surface.closest(p).position - p).squaredNorm(); });
    return std::max(missing, root_mean_square_distance(every(decoded.positions, samples_.size()), tree_));
  }

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
  Result<Partition> partition = partition_points(points, options);
  if (!partition) return partition.error();
  std::vector<BasePlane> planes = base_planes(points, *partition);
  const double spacing = spacing_for_resolution(points, *partition, planes, kPointSpacings);
  // From here on the points' surface is a mesh, finer than the points: MLS projections cost too much to be made at
  // every spacing that is tried.
  const MlsSurface surface(points.positions);
  const ElevationMaps maps = resample_points(points, surface, *partition, planes, spacing);
  const ClosedMesh closed = closed_mesh(maps);
  PartitionedMesh::Content content;
  content.mesh = closed.mesh;
  content.mesh.triangles.resize(closed.mesh.triangles.size() - closed.filling.inserted);
  const std::vector<std::uint32_t> patch_of_vertex = patches_of_samples(maps);
  partition->patch_of.clear();
  for (const auto& triangle : content.mesh.triangles) partition->patch_of.push_back(patch_of_vertex[triangle[0]]);
  content.partition = std::move(*partition);
  content.planes = std::move(planes);
  content.box = bounding_box(points.positions);
  content.is_points = true;
  content.point_count = points.positions.size();
  return Made(std::make_unique<PartitionedMesh>(std::move(content), closed.mesh, samples));
}

}  // namespace emap
