#include "libemap/partition/partitioning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libemap/partition/coarsening.h"
#include "libemap/partition/finishing.h"
#include "libemap/partition/islands.h"
#include "libemap/partition/lloyd_partition.h"
#include "libemap/partition/patch_merging.h"
#include "libemap/partition/split_merge.h"
#include "libemap/surface/bounding_box.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr std::size_t kGroupSize = 20;      // elements a group
constexpr double kGroupSpreadDegrees = 25;  // of normals within a group
constexpr double kCellSize = 0.6;           // of footprints, in square roots of the mean area of an element
constexpr double kDiscTolerance = 1.5;      // height tolerance of discs, in the same unit

double mean_element_size(const ElementGraph& graph) {
  return std::sqrt(graph.total_area() / static_cast<double>(graph.size()));
}

// Rounds of smoothing that only even out noise; more of them may turn normals by what the aperture leaves to the
// steepest slope that can still be sampled, or sharp edges would get sheer rims.
constexpr int kRoundsAgainstNoise = 2;
constexpr double kSteepestDegrees = 85;

void smooth_further(const PartitionOptions& options, ElementGraph& graph) {
  smooth_normals_within(options.smoothing_rounds - kRoundsAgainstNoise,
                        std::max(kSteepestDegrees - options.aperture_degrees, 0.0), graph);
}

constexpr std::size_t kIslandElements = 64;  // unconnected parts of at most so many elements are linked
constexpr double kIslandReach = 8;           // to what lies within so many element sizes

RoughPartition rough_partition(const ElementGraph& groups, const Footprints& discs, const PartitionOptions& options) {
  if (options.method == PartitionMethod::split_merge)
    return split_merge_partition(groups, discs,
                                 {.split_degrees = std::min(options.split_degrees, options.aperture_degrees),
                                  .aperture_degrees = options.aperture_degrees,
                                  .strict = options.strict});
  RoughPartition seeded = lloyd_partition(
      groups, discs, {.aperture_degrees = options.aperture_degrees, .least_patches = options.least_patches});
  return merge_patches(groups, discs, std::move(seeded),
                       {.aperture_degrees = options.aperture_degrees,
                        .least_patches = static_cast<std::size_t>(options.least_patches),
                        .strict = options.strict});
}

Partition partition_elements(const ElementGraph& graph, const Footprints& footprints, const BoundingBox& box,
                             const PartitionOptions& options) {
  const Eigen::Vector3d origin = (box.minimum + box.maximum) / 2;
  const Coarsening coarsening = coarsen(graph, kGroupSize, kGroupSpreadDegrees);
  const double group_size = mean_element_size(coarsening.graph);
  const DiscFootprints discs(coarsening.graph, origin, kCellSize * group_size,
                             options.strict ? kDiscTolerance * group_size : std::numeric_limits<double>::infinity());
  const RoughPartition rough = rough_partition(coarsening.graph, discs, options);
  const double scrap_error = options.strict ? options.scrap_error * box.diagonal() : 0;
  return finish_partition(graph, footprints, coarsening, rough,
                          {.aperture_degrees = options.aperture_degrees,
                           .scrap_error = scrap_error,
                           .optimise_boundaries = options.optimise_boundaries});
}

void link_islands(ElementGraph& graph) {
  if (const std::vector<AdjacentPair> links = island_links(graph, kIslandElements, kIslandReach); !links.empty())
    add_links(links, graph);
}

double fold_tolerance(const PartitionOptions& options, double diagonal) {
  return options.strict ? options.fold_tolerance * diagonal : std::numeric_limits<double>::infinity();
}

}  // namespace

void PartitionOptions::declare(thin::OptionTable& table) {
  table.add_choice("partition", method, {{"gla", PartitionMethod::gla}, {"split-merge", PartitionMethod::split_merge}},
                   {.explanation = "how the surface is cut into patches: generalised Lloyd, or split and merge"});
  table.add("aperture", aperture_degrees,
            {.unit = "degrees",
             .maximum = 89,
             .above = 0,
             .explanation = "widest angle between a patch's normals and its plane's"});
  table.add("split", split_degrees,
            {.unit = "degrees",
             .maximum = 89,
             .above = 0,
             .explanation = "split-merge: aperture of the clusters before merging"});
  table.add("patches", least_patches, {.minimum = 1, .explanation = "gla: at least so many patches"});
  table.add("strict", strict, {.explanation = "let no patch have two sheets over one place"});
  table.add("fold_tolerance", fold_tolerance,
            {.unit = "diagonals", .minimum = 0, .maximum = 1, .explanation = "sheets nearer than this count as one"});
  table.add("scrap_error", scrap_error,
            {.unit = "diagonals",
             .minimum = 0,
             .maximum = 1,
             .explanation = "root mean square error that folds too small for patches of their own may add"});
  table.add("optimise_boundaries", optimise_boundaries, {.explanation = "shorten the boundaries between patches"});
  table.add("smoothing_rounds", smoothing_rounds,
            {.minimum = 0, .maximum = 100, .explanation = "of the normals that the methods see"});
  table.add("neighbours", neighbour_count,
            {.minimum = 1, .maximum = 64, .explanation = "points: k of the neighbour graph"});
}

Result<Partition> partition_mesh(const Mesh& mesh, const PartitionOptions& options) {
  if (mesh.triangles.empty())
    return Error{ErrorKind::input, "the mesh has no triangles to make patches of; read it as points"};
  ElementGraph graph = mesh_graph(mesh, std::min(options.smoothing_rounds, kRoundsAgainstNoise));
  if (!(graph.total_area() > 0))
    return Error{ErrorKind::input, "no triangle of the mesh has an area; there is no surface to make patches of"};
  smooth_further(options, graph);
  link_islands(graph);
  const BoundingBox box = bounding_box(mesh.positions);
  const Eigen::Vector3d origin = (box.minimum + box.maximum) / 2;
  const TriangleFootprints footprints(mesh, origin, kCellSize * mean_element_size(graph),
                                      fold_tolerance(options, box.diagonal()));
  return partition_elements(graph, footprints, box, options);
}

Result<Partition> partition_points(const PointSet& points, const PartitionOptions& options) {
  if (points.positions.size() < 3)
    return Error{ErrorKind::input, "there are fewer than three points: they make no surface"};
  if (points.normals.size() != points.positions.size())
    return Error{ErrorKind::input, "the points have no normals; they must be found first"};
  ElementGraph graph =
      point_graph(points, options.neighbour_count, std::min(options.smoothing_rounds, kRoundsAgainstNoise));
  if (!(graph.total_area() > 0)) return Error{ErrorKind::input, "all points lie at one place: they make no surface"};
  smooth_further(options, graph);
  link_islands(graph);
  const BoundingBox box = bounding_box(points.positions);
  // Tangent discs of neighbouring points meet at different heights: by their size where the surface is rough.
  const double size = mean_element_size(graph);
  const double tolerance = std::max(fold_tolerance(options, box.diagonal()), kDiscTolerance * size);
  const DiscFootprints footprints(graph, (box.minimum + box.maximum) / 2, kCellSize * size, tolerance);
  return partition_elements(graph, footprints, box, options);
}

}  // namespace emap
