#pragma once

// What an encoder needs of a surface: cut into patches, sampled over quantised planes at any spacing, and measured
// against what comes out of the decoder. Meshes and point sets alike.

#include <memory>
#include <span>
#include <vector>

#include "libemap/elevation/elevation_map.h"
#include "libemap/partition/partitioning.h"
#include "libemap/surface/bounding_box.h"
#include "libemap/surface/surface.h"
#include "libthin/foundation/result.h"

namespace emap {

// How much is done for masks that cost little.
enum class MaskEffort {
  none,
  boundaries,  // coding/mask_choice.h
  seams        // elevation/seam_smoothing.h as well, which is for the worse where seams lie along creases
};

class SurfaceToEncode {
 public:
  virtual ~SurfaceToEncode() = default;

  virtual bool is_points() const = 0;
  virtual std::size_t point_count() const = 0;  // what bits per point are counted by: all vertices or points
  virtual const BoundingBox& box() const = 0;
  virtual const std::vector<BasePlane>& planes() const = 0;  // before quantisation, one for each patch

  // Of the elements of a patch; a vertex of several triangles comes several times.
  virtual std::vector<Eigen::Vector3d> positions_of(std::size_t patch) const = 0;

  virtual ElevationMaps resample(std::span<const BasePlane> planes, double spacing, MaskEffort effort) const = 0;

  // E_rms of equation 3.2 between this surface and the decoded one, by samples of both; infinite where nothing was
  // decoded. Every triangle of this one (up to a million) and every one that fills a gap of the other is looked at, so
  // that small parts that are missing or wrong show; or, by a quick look, a quarter of all that.
  virtual double error_of(const ElevationMaps& decoded, bool quick = false) const = 0;

  // The same surface cut otherwise.
  virtual thin::Result<std::unique_ptr<SurfaceToEncode>> repartitioned(const PartitionOptions& options) const = 0;
};

constexpr std::size_t kSteeringSamples = 200000;

// samples: at least so many on each surface, for error_of(). Errors: as partition_mesh() and partition_points(). Points
// get normals where they have none; what is cut, sampled and measured of them is a mesh through them
// (surface/point_mesh.h), or through their projections onto the MLS surface where they are noisy.
thin::Result<std::unique_ptr<SurfaceToEncode>> mesh_to_encode(Mesh mesh, const PartitionOptions& options,
                                                              std::size_t samples = kSteeringSamples);
thin::Result<std::unique_ptr<SurfaceToEncode>> points_to_encode(PointSet points, const PartitionOptions& options,
                                                                std::size_t samples = kSteeringSamples);

}  // namespace emap
