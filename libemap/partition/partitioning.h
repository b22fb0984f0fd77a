#pragma once

// Cuts a surface into patches, each a height field over a plane. Every element (triangle, point) gets exactly one
// patch, and every patch is connected over the elements' adjacency.
//
//   Result<Partition> partition = partition_mesh(mesh, {.method = PartitionMethod::gla, .aperture_degrees = 80});

#include "libemap/partition/partition.h"
#include "libemap/surface/surface.h"
#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"

namespace emap {

enum class PartitionMethod { gla, split_merge };

struct PartitionOptions {
  PartitionMethod method = PartitionMethod::gla;
  double aperture_degrees = 80;  // widest angle between a patch's (smoothed) normals and its plane's normal
  double split_degrees = 40;     // split_merge: the aperture down to which clusters are split
  int least_patches = 1;         // gla: at least so many
  bool strict = true;            // refuse second sheets
  double fold_tolerance = 1e-4;  // of the diagonal: sheets nearer to each other than this count as one
  double scrap_error = 8e-6;     // of the diagonal: RMS error that folds too small for patches of their own may add
  bool optimise_boundaries = true;
  int smoothing_rounds = 2;  // of the normals that the methods see
  int neighbour_count = 5;   // points: k of the neighbour graph

  void declare(thin::OptionTable& table);

  bool operator==(const PartitionOptions&) const = default;
};

// Errors (input): no triangles; no triangle with an area.
thin::Result<Partition> partition_mesh(const Mesh& mesh, const PartitionOptions& options = {});

// Errors (input): fewer than 3 points, all at one place, or no normals (surface/point_normals.h makes them).
thin::Result<Partition> partition_points(const PointSet& points, const PartitionOptions& options = {});

}  // namespace emap
