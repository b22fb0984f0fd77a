#include "libemap/partition/split_merge.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libemap/partition/components.h"
#include "libemap/partition/normal_cone.h"
#include "libemap/partition/patch_merging.h"
#include "libthin/foundation/principal_axes.h"

namespace emap {
namespace {

NormalCone cone_of(const ElementGraph& graph, const std::vector<std::uint32_t>& elements) {
  std::vector<Eigen::Vector3d> normals;
  normals.reserve(elements.size());
  for (const std::uint32_t element : elements) normals.push_back(graph.normals[element]);
  return normal_cone(normals);
}

// The elements on the far side of the plane through the centre of mass, across the first principal axis, leave
// `elements`. Where all are at one place, half of them do.
std::vector<std::uint32_t> split_off(const ElementGraph& graph, std::vector<std::uint32_t>& elements) {
  std::vector<double> coordinates, weights;
  for (const std::uint32_t element : elements) {
    coordinates.insert(coordinates.end(), graph.centres[element].begin(), graph.centres[element].end());
    weights.push_back(graph.areas[element]);
  }
  const thin::PrincipalAxes axes = thin::principal_axes(coordinates, 3, weights);
  const Eigen::Map<const Eigen::Vector3d> centroid(axes.centroid.data()), axis(axes.axis(0).data());
  auto middle = std::stable_partition(elements.begin(), elements.end(), [&](std::uint32_t element) {
    return axis.dot(graph.centres[element] - centroid) < 0;
  });
  if (middle == elements.begin() || middle == elements.end())
    middle = elements.begin() + static_cast<std::ptrdiff_t>(elements.size() / 2);
  std::vector<std::uint32_t> far(middle, elements.end());
  elements.erase(middle, elements.end());
  return far;
}

// Cluster numbers, such that each cluster's cone is narrow; clusters may still be in several pieces.
std::vector<std::uint32_t> narrow_clusters(const ElementGraph& graph, double cosine) {
  std::vector<std::uint32_t> cluster_of(graph.size());
  std::vector<std::uint32_t> all(graph.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<std::vector<std::uint32_t>> waiting = {std::move(all)};
  std::uint32_t clusters = 0;
  while (!waiting.empty()) {
    std::vector<std::uint32_t> elements = std::move(waiting.back());
    waiting.pop_back();
    if (elements.size() < 2 || cone_of(graph, elements).aperture_cosine >= cosine) {
      for (const std::uint32_t element : elements) cluster_of[element] = clusters;
      ++clusters;
      continue;
    }
    waiting.push_back(split_off(graph, elements));
    waiting.push_back(std::move(elements));
  }
  return cluster_of;
}

}  // namespace

RoughPartition split_clusters(const ElementGraph& graph, double split_degrees) {
  const std::vector<std::uint32_t> cluster_of =
      narrow_clusters(graph, std::cos(split_degrees * std::numbers::pi / 180));
  RoughPartition rough;
  rough.patch_of.resize(graph.size());
  for (const Component& cluster : components_of(graph, cluster_of)) {
    for (const std::uint32_t element : cluster.elements)
      rough.patch_of[element] = static_cast<std::uint32_t>(rough.normals.size());
    rough.normals.push_back(cone_of(graph, cluster.elements).axis);
    rough.seeds.push_back(cluster.elements.front());
  }
  return rough;
}

RoughPartition split_merge_partition(const ElementGraph& graph, const Footprints& footprints,
                                     const SplitMergeOptions& options) {
  return merge_patches(graph, footprints, split_clusters(graph, options.split_degrees),
                       {.aperture_degrees = options.aperture_degrees, .least_patches = 1, .strict = options.strict});
}

}  // namespace emap
