#pragma once

// The whole way from a mesh to its maps, for tests.

#include "libemap/elevation/base_plane.h"
#include "libemap/elevation/resampling.h"
#include "libemap/partition/partitioning.h"
#include "libemap/surface/surface_distance.h"
#include "tests/support/surfaces.h"

namespace emap::test {

struct SampledMesh {
  Partition partition;
  std::vector<BasePlane> planes;
  ElevationMaps maps;
};

inline SampledMesh sampled(const Mesh& mesh, double mu, const PartitionOptions& options = {}) {
  SampledMesh result;
  result.partition = *partition_mesh(mesh, options);
  result.planes = base_planes(mesh, result.partition);
  result.maps = resample_mesh(mesh, result.partition, result.planes,
                              spacing_for_resolution(mesh, result.partition, result.planes, mu));
  return result;
}

inline double error_in_diagonals(const Mesh& original, const Mesh& other) {
  const SurfaceComparison comparison = *compare_surfaces({original.positions, {}, original.triangles},
                                                         {other.positions, {}, other.triangles}, {.samples = 20000});
  return comparison.error() / comparison.diagonal;
}

}  // namespace emap::test
