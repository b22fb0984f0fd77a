#pragma once

// Seams between patches, smooth at the scale of the maps' samples: wiggles of a few samples cost bits in the masks of
// both sides and are worth nothing. By motion of the labels towards what most of the surroundings have (B. Merriman,
// J. Bence, S. Osher, "Diffusion generated motion by mean curvature", 1992).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libemap/elevation/elevation_map.h"
#include "libemap/partition/partition.h"
#include "libemap/surface/surface.h"

namespace emap {

struct SeamSmoothingOptions {
  double reach = 4;            // spacings: how far the surroundings of a triangle go
  double crease_cosine = 0.7;  // between normals: what is turned away more doesn't count, so that seams stay on creases
  double steepest_cosine =
      0.34;  // to the plane of the new patch; steeper ones change only to where they are less steep
  int rounds = 5;
  double hole = 0.4;  // spacings: what gap filling misses by more
};

// The neighbours of each triangle over its edges, three at most, in no order of the edges; kNoTriangle where there are
// fewer.
constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;
using TriangleNeighbours = std::vector<std::array<std::uint32_t, 3>>;
TriangleNeighbours triangle_neighbours(const Mesh& mesh);

// Vertices at which triangles of different patches meet.
std::vector<Eigen::Vector3d> vertices_on_seams(const Mesh& mesh, const std::vector<std::uint32_t>& patch_of);

// For each triangle its patch, beginning with the partition's. maps: the partition's, resampled; a triangle that would
// lie over or under what is in the new patch's map there keeps its patch. Patches may lose all their triangles.
// O(triangles at seams * triangles within reach) for each round. Deterministic for any number of threads.
std::vector<std::uint32_t> smooth_seams(const Mesh& mesh, const TriangleNeighbours& neighbours,
                                        const Partition& partition, const ElevationMaps& maps,
                                        const SeamSmoothingOptions& options = {});

struct SmoothlyCut {
  Partition partition;  // as given, but for `patch_of`
  ElevationMaps maps;
};

// The mesh sampled over the partition with smooth seams; where gap filling would leave a hole at them, they stay as
// they are.
SmoothlyCut resample_with_smooth_seams(const Mesh& mesh, const TriangleNeighbours& neighbours,
                                       const Partition& partition, std::span<const BasePlane> planes, double spacing,
                                       const SeamSmoothingOptions& options = {});

}  // namespace emap
