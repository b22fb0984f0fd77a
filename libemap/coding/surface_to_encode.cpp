#include "libemap/coding/surface_to_encode.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/elevation/resampling.h"
#include "libemap/surface/surface_samples.h"
#include "libemap/surface/triangle_tree.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSamples = 60000;

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

class MeshToEncode : public SurfaceToEncode {
 public:
  MeshToEncode(const Mesh& mesh, Partition partition)
      : mesh_(mesh),
        partition_(std::move(partition)),
        elements_(partition_.elements_of_patches()),
        planes_(base_planes(mesh, partition_)),
        box_(bounding_box(mesh.positions)),
        tree_(mesh),
        samples_(sample_surface(mesh, kSamples, 1)) {}

  bool is_points() const override { return false; }
  std::size_t point_count() const override { return mesh_.positions.size(); }
  const BoundingBox& box() const override { return box_; }
  const std::vector<BasePlane>& planes() const override { return planes_; }

  std::vector<Vector3d> positions_of(std::size_t patch) const override {
    std::vector<Vector3d> positions;
    positions.reserve(3 * elements_[patch].size());
    for (const std::uint32_t triangle : elements_[patch])
      for (const std::uint32_t vertex : mesh_.triangles[triangle]) positions.push_back(mesh_.positions[vertex]);
    return positions;
  }

  ElevationMaps resample(std::span<const BasePlane> planes, double spacing) const override {
    return resample_mesh(mesh_, partition_, planes, spacing);
  }

  double error_of(const ElevationMaps& decoded) const override {
    const Mesh mesh = closed_mesh(decoded).mesh;
    if (mesh.triangles.empty()) return std::numeric_limits<double>::infinity();
    const double missing = root_mean_square_distance(samples_, TriangleTree(mesh));
    return std::max(missing, root_mean_square_distance(sample_surface(mesh, kSamples, 2), tree_));
  }

 private:
  const Mesh& mesh_;
  Partition partition_;
  std::vector<std::vector<std::uint32_t>> elements_;
  std::vector<BasePlane> planes_;
  BoundingBox box_;
  TriangleTree tree_;
  std::vector<Vector3d> samples_;
};

}  // namespace

thin::Result<std::unique_ptr<SurfaceToEncode>> mesh_to_encode(const Mesh& mesh, const PartitionOptions& options) {
  thin::Result<Partition> partition = partition_mesh(mesh, options);
  if (!partition) return partition.error();
  return std::unique_ptr<SurfaceToEncode>(std::make_unique<MeshToEncode>(mesh, std::move(*partition)));
}

thin::Result<std::unique_ptr<SurfaceToEncode>> points_to_encode(const PointSet&, const PartitionOptions&) {
  return thin::Error{thin::ErrorKind::input, "points: not yet"};
}

}  // namespace emap
