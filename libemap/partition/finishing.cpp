#include "libemap/partition/finishing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "libemap/partition/boundary_optimisation.h"
#include "libemap/partition/components.h"
#include "libemap/partition/normal_cone.h"

namespace emap {
namespace {

constexpr std::size_t kScrapElements = 48;  // leftovers of so many elements may join a patch whatever their normals
constexpr double kScrapShare = 3e-4;        // and of so much of the area
constexpr double kScrapLeniency = 5;        // times the height tolerance
constexpr std::uint32_t kBlocked = kNoPatch - 1;

class Finishing {
 public:
  Finishing(const ElementGraph& graph, const Footprints& footprints, const FinishingOptions& options)
      : graph_(graph),
        footprints_(footprints),
        options_(options),
        aperture_cosine_(std::cos(options.aperture_degrees * std::numbers::pi / 180)),
        sheets_(footprints),
        patch_of_(graph.size(), kNoPatch) {}

  Partition run(const Coarsening& coarsening, const RoughPartition& rough) {
    add_planes(coarsening, rough);
    add_seeds(coarsening, rough);
    const std::vector<std::uint32_t> interiors = fixed_interiors(coarsening, rough);
    flood(graph_, {.aperture_cosine = aperture_cosine_, .fixed = interiors}, sheets_, patch_of_);
    flood(graph_, {.aperture_cosine = aperture_cosine_}, sheets_, patch_of_);
    absorb_scraps();
    join_least_scraps();
    while (add_patches_for_leftovers()) {
      flood(graph_, {.aperture_cosine = aperture_cosine_}, sheets_, patch_of_);
      absorb_scraps();
    }
    if (options_.optimise_boundaries) optimise_boundaries(graph_, aperture_cosine_, sheets_, patch_of_);
    return partition();
  }

 private:
  void add_planes(const Coarsening& coarsening, const RoughPartition& rough) {
    std::vector<std::vector<Eigen::Vector3d>> normals(rough.normals.size());
    for (std::size_t i = 0; i < graph_.size(); ++i)
      if (const std::uint32_t patch = rough.patch_of[coarsening.group_of[i]]; patch != kNoPatch)
        normals[patch].push_back(graph_.normals[i]);
    for (std::size_t patch = 0; patch < normals.size(); ++patch) {
      const NormalCone cone = normal_cone(normals[patch]);
      sheets_.add_patch(cone.aperture_cosine >= aperture_cosine_ ? cone.axis : rough.normals[patch]);
    }
  }

  // In each patch the element of the seed's group whose normal is nearest to the plane's.
  void add_seeds(const Coarsening& coarsening, const RoughPartition& rough) {
    std::vector<std::uint32_t> patch_of_group(coarsening.graph.size(), kNoPatch);
    for (std::uint32_t patch = 0; patch < rough.seeds.size(); ++patch) patch_of_group[rough.seeds[patch]] = patch;
    std::vector<std::uint32_t> seeds(rough.seeds.size(), kNoPatch);
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      const std::uint32_t patch = patch_of_group[coarsening.group_of[i]];
      if (patch == kNoPatch) continue;
      const auto cosine = [&](std::uint32_t element) { return graph_.normals[element].dot(sheets_.normal(patch)); };
      if (seeds[patch] == kNoPatch || cosine(i) > cosine(seeds[patch])) seeds[patch] = i;
    }
    for (std::uint32_t patch = 0; patch < seeds.size(); ++patch) take(seeds[patch], patch);
  }

  void take(std::uint32_t element, std::uint32_t patch) {
    if (sheets_.try_add(element, patch)) patch_of_[element] = patch;
  }

  // Groups whose neighbours are all in the same patch keep theirs; along the boundaries elements choose anew.
  std::vector<std::uint32_t> fixed_interiors(const Coarsening& coarsening, const RoughPartition& rough) const {
    const ElementGraph& groups = coarsening.graph;
    std::vector<std::uint32_t> fixed_group(groups.size(), kNoPatch);
    for (std::uint32_t group = 0; group < groups.size(); ++group) {
      const std::span<const Adjacency> neighbours = groups.neighbours(group);
      const bool inside = std::all_of(neighbours.begin(), neighbours.end(), [&](const Adjacency& neighbour) {
        return rough.patch_of[neighbour.element] == rough.patch_of[group];
      });
      if (inside) fixed_group[group] = rough.patch_of[group];
    }
    std::vector<std::uint32_t> fixed(graph_.size());
    for (std::size_t i = 0; i < graph_.size(); ++i) fixed[i] = fixed_group[coarsening.group_of[i]];
    return fixed;
  }

  void absorb_scraps() {
    std::vector<std::uint32_t> fixed(graph_.size(), kBlocked);
    const double area = graph_.total_area();
    bool any = false;
    for (const Component& leftover : components_of(graph_, patch_of_, kNoPatch)) {
      if (leftover.elements.size() > kScrapElements || leftover.area > kScrapShare * area) continue;
      any = true;
      for (const std::uint32_t element : leftover.elements) fixed[element] = kNoPatch;
    }
    if (any) flood(graph_, {.aperture_cosine = -1, .fixed = fixed, .leniency = kScrapLeniency}, sheets_, patch_of_);
  }

  // Scraps join the patch along which they lie longest, least damage first, until all may add no more.
  void join_least_scraps() {
    struct Scrap {
      Component part;
      double damage;  // squared distance to the patch integrated over the scrap, rising from 0 at one of its ends
    };
    std::vector<Scrap> scraps;
    for (Component& leftover : components_of(graph_, patch_of_, kNoPatch)) {
      const double extent = extent_of(leftover.elements);
      scraps.push_back({std::move(leftover), leftover.area * extent * extent / 3});
    }
    std::stable_sort(scraps.begin(), scraps.end(), [](const Scrap& a, const Scrap& b) { return a.damage < b.damage; });
    double allowance = options_.scrap_error * options_.scrap_error * graph_.total_area();
    for (const Scrap& scrap : scraps) {
      allowance -= scrap.damage;
      if (allowance < 0) break;
      const std::uint32_t patch = longest_neighbour(scrap.part.elements);
      for (const std::uint32_t element : scrap.part.elements) patch_of_[element] = patch;
    }
  }

  // About as far as a point of the elements can be from what lies around them.
  double extent_of(const std::vector<std::uint32_t>& elements) const {
    Eigen::Vector3d low = graph_.centres[elements.front()], high = low;
    double largest_area = 0;
    for (const std::uint32_t element : elements) {
      largest_area = std::max(largest_area, graph_.areas[element]);
      low = low.cwiseMin(graph_.centres[element]);
      high = high.cwiseMax(graph_.centres[element]);
    }
    return (high - low).norm() + 1.5 * std::sqrt(largest_area);
  }

  std::uint32_t longest_neighbour(const std::vector<std::uint32_t>& elements) const {
    std::map<std::uint32_t, double> lengths;
    for (const std::uint32_t element : elements)
      for (const Adjacency& side : graph_.neighbours(element))
        if (patch_of_[side.element] != kNoPatch) lengths[patch_of_[side.element]] += side.boundary_length;
    const auto longest = std::max_element(lengths.begin(), lengths.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
    return longest == lengths.end() ? kNoPatch : longest->first;
  }

  // A seed in each connected leftover, with the plane that suits what can be reached from it. False where nothing is
  // left.
  bool add_patches_for_leftovers() {
    const std::vector<Component> leftovers = components_of(graph_, patch_of_, kNoPatch);
    for (const Component& leftover : leftovers) {
      const std::uint32_t seed = largest_of(leftover.elements);
      std::vector<Eigen::Vector3d> normals;
      for (const std::uint32_t element : leftover.elements)
        if (graph_.normals[element].dot(graph_.normals[seed]) > 0) normals.push_back(graph_.normals[element]);
      const NormalCone cone = normal_cone(normals);
      const bool one_cone = !normals.empty() && cone.aperture_cosine >= aperture_cosine_;
      const Eigen::Vector3d seed_normal =
          graph_.normals[seed].isZero(0) ? Eigen::Vector3d::UnitZ().eval() : graph_.normals[seed];
      take(seed, sheets_.add_patch(one_cone ? cone.axis : seed_normal));
    }
    return !leftovers.empty();
  }

  std::uint32_t largest_of(const std::vector<std::uint32_t>& elements) const {
    return *std::max_element(elements.begin(), elements.end(), [&](std::uint32_t a, std::uint32_t b) {
      return graph_.areas[a] != graph_.areas[b] ? graph_.areas[a] < graph_.areas[b] : a > b;
    });
  }

  // Patches in the order of their smallest elements; what boundary optimisation may have cut off counts as its own.
  Partition partition() const {
    Partition result;
    result.patch_of.resize(graph_.size());
    for (const Component& component : components_of(graph_, patch_of_)) {
      const auto index = static_cast<std::uint32_t>(result.patches.size());
      Patch patch;
      patch.normal = sheets_.normal(patch_of_[component.elements.front()]);
      patch.element_count = static_cast<std::uint32_t>(component.elements.size());
      for (const std::uint32_t element : component.elements) {
        result.patch_of[element] = index;
        patch.area += graph_.areas[element];
        patch.aperture_cosine = std::min(patch.aperture_cosine, least_cosine(graph_, element, patch.normal));
        if (!graph_.normals[element].isZero(0))
          patch.distortion += graph_.areas[element] * (graph_.normals[element] - patch.normal).squaredNorm();
      }
      result.patches.push_back(patch);
    }
    return result;
  }

  const ElementGraph& graph_;
  const Footprints& footprints_;
  const FinishingOptions& options_;
  double aperture_cosine_;
  SheetMap sheets_;
  std::vector<std::uint32_t> patch_of_;
};

}  // namespace

Partition finish_partition(const ElementGraph& graph, const Footprints& footprints, const Coarsening& coarsening,
                           const RoughPartition& rough, const FinishingOptions& options) {
  return Finishing(graph, footprints, options).run(coarsening, rough);
}

}  // namespace emap
