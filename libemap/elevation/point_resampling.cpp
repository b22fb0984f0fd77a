// Elevation maps of point sets: each sample by its own intersection of a line with the MLS surface.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "libemap/elevation/map_grid.h"
#include "libemap/elevation/resampling.h"
#include "libemap/surface/bounding_box.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr int kIterations = 8;
constexpr double kConverged = 1e-4;     // change of the elevation, in spacings of the points
constexpr double kSteepest = 0.05;      // cosine between line and surface normal
constexpr double kDiscRadius = 1.6;     // of the discs that find candidate samples, in spacings of the points
constexpr double kFarthestInput = 1.0;  // of a sample from its nearest input point, likewise

class PatchSampler {
 public:
  PatchSampler(const PointSet& points, const MlsSurface& surface, const Partition& partition, double spacing)
      : points_(points), surface_(surface), partition_(partition), spacing_(spacing) {}

  ElevationPatch sample(std::uint32_t patch_index, const std::vector<std::uint32_t>& members,
                        const BasePlane& plane) const {
    double last_u = -1, last_v = -1, margin = 0;
    for (const std::uint32_t point : members) {
      const Eigen::Vector3d place = over_plane(plane, spacing_, points_.positions[point]);
      last_u = std::max(last_u, place.x());
      last_v = std::max(last_v, place.y());
      margin = std::max(margin, radius_of(point) / spacing_);
    }
    ElevationPatch patch = empty_patch(plane, last_u + margin, last_v + margin);
    mark_candidates(members, patch);
    thin::parallel_ranges(patch.rows, 4, [&](std::size_t begin, std::size_t end) {
      for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row)
        for (std::uint32_t column = 0; column < patch.columns; ++column) intersect(patch_index, row, column, patch);
    });
    crop(patch);
    return patch;
  }

 private:
  double radius_of(std::uint32_t point) const {
    return kDiscRadius * surface_.nearest(points_.positions[point]).spacing;
  }

  // Marks samples over the discs around the points, each with the height of the disc whose point is nearest in the
  // plane.
  void mark_candidates(const std::vector<std::uint32_t>& members, ElevationPatch& patch) const {
    std::vector<double> nearest(patch.mask.size(), std::numeric_limits<double>::infinity());
    const auto columns = static_cast<std::int64_t>(patch.columns), rows = static_cast<std::int64_t>(patch.rows);
    for (const std::uint32_t point : members) {
      const Eigen::Vector3d place = over_plane(patch.plane, spacing_, points_.positions[point]);
      const double radius = radius_of(point) / spacing_;
      const auto first = [&](double centre) {
        return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(centre - radius)));
      };
      const auto last = [&](double centre, std::int64_t count) {
        return std::min(count - 1, static_cast<std::int64_t>(std::floor(centre + radius)));
      };
      for (std::int64_t row = first(place.y()); row <= last(place.y(), rows); ++row)
        for (std::int64_t column = first(place.x()); column <= last(place.x(), columns); ++column) {
          const double distance =
              std::hypot(static_cast<double>(column) - place.x(), static_cast<double>(row) - place.y());
          const auto sample = static_cast<std::size_t>(row * columns + column);
          if (distance > radius || !(distance < nearest[sample])) continue;
          nearest[sample] = distance;
          patch.mask[sample] = 1;
          patch.elevation[sample] = place.z();
        }
    }
  }

  // Figure 3.9: project, intersect the tangent plane with the line, project again.
  void intersect(std::uint32_t patch_index, std::uint32_t row, std::uint32_t column, ElevationPatch& patch) const {
    const std::size_t sample = std::size_t{row} * patch.columns + column;
    if (!patch.mask[sample]) return;
    const Eigen::Vector3d& direction = patch.plane.normal;
    Eigen::Vector3d place = sample_position(patch, spacing_, row, column);
    bool converged = false;
    for (int iteration = 0; iteration < kIterations && !converged; ++iteration) {
      const MlsProjection projection = surface_.project(place);
      const double cosine = projection.normal.dot(direction);
      if (std::abs(cosine) < kSteepest) break;
      const double step = projection.normal.dot(projection.position - place) / cosine;
      place += step * direction;
      converged = projection.in_domain && std::abs(step) < kConverged * surface_.nearest(place).spacing;
    }
    const MlsSurface::Nearest nearest = surface_.nearest(place);
    const bool is_here = converged && partition_.patch_of[nearest.index] == patch_index &&
                         nearest.distance <= kFarthestInput * nearest.spacing;
    patch.mask[sample] = is_here ? 1 : 0;
    patch.elevation[sample] = is_here ? direction.dot(place - patch.plane.origin) : 0;
  }

  const PointSet& points_;
  const MlsSurface& surface_;
  const Partition& partition_;
  double spacing_;
};

}  // namespace

ElevationMaps resample_points(const PointSet& points, const MlsSurface& surface, const Partition& partition,
                              std::span<const BasePlane> planes, double spacing) {
  assert(spacing > 0 && planes.size() == partition.patches.size());
  assert(partition.patch_of.size() == points.positions.size());
  const BoundingBox box = bounding_box(points.positions);
  ElevationMaps maps{spacing, box.diagonal(), box.minimum, std::vector<ElevationPatch>(planes.size())};
  const std::vector<std::vector<std::uint32_t>> members = partition.elements_of_patches();
  const PatchSampler sampler(points, surface, partition, spacing);
  thin::parallel_ranges(planes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (auto patch = static_cast<std::uint32_t>(begin); patch < end; ++patch)
      maps.patches[patch] = sampler.sample(patch, members[patch], planes[patch]);
  });
  return maps;
}

double spacing_for_resolution(const PointSet& points, const Partition& partition, std::span<const BasePlane> planes,
                              double mu) {
  // Each point stands for an equal share of its patch's area, foreshortened by its normal's angle to the plane.
  double projected_area = 0;
  std::vector<double> share(planes.size());
  for (std::size_t patch = 0; patch < planes.size(); ++patch)
    share[patch] = partition.patches[patch].area / partition.patches[patch].element_count;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const std::uint32_t patch = partition.patch_of[i];
    projected_area += share[patch] * std::abs(points.normals[i].dot(planes[patch].normal));
  }
  return mu * std::sqrt(projected_area / static_cast<double>(points.positions.size()));
}

}  // namespace emap
