#include "libemap/partition/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "libemap/partition/normal_cone.h"
#include "libemap/partition/sheet_map.h"

namespace emap {
namespace {

struct Cluster {
  std::vector<std::uint32_t> elements;
  double area = 0;
  Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();  // area-weighted
  Eigen::Vector3d plane_normal = Eigen::Vector3d::UnitZ();
  std::set<std::uint32_t> neighbours;
  std::uint32_t version = 0;  // counts merges: what was said of an earlier version no longer holds
};

// Against its mean normal, a cluster's J is 2 (area - |normal_sum|): so much it grows by a merge.
double growth(const Cluster& a, const Cluster& b) {
  return 2 * (a.normal_sum.norm() + b.normal_sum.norm() - (a.normal_sum + b.normal_sum).norm());
}

class Merging {
 public:
  Merging(const ElementGraph& graph, const Footprints& footprints, RoughPartition rough, const MergingOptions& options)
      : graph_(graph),
        footprints_(footprints),
        rough_(std::move(rough)),
        options_(options),
        aperture_cosine_(std::cos(options.aperture_degrees * std::numbers::pi / 180)),
        clusters_(rough_.normals.size()),
        remaining_(clusters_.size()) {}

  RoughPartition run() {
    fill_clusters();
    for (std::uint32_t cluster = 0; cluster < clusters_.size(); ++cluster)
      for (const std::uint32_t neighbour : clusters_[cluster].neighbours)
        if (cluster < neighbour) propose(cluster, neighbour);
    while (!pairs_.empty() && remaining_ > options_.least_patches) {
      const Pair pair = pairs_.begin()->second;
      pairs_.erase(pairs_.begin());
      if (clusters_[pair.first].version != pair.first_version || clusters_[pair.second].version != pair.second_version)
        continue;
      if (const std::optional<Eigen::Vector3d> normal = plane_of_union(pair.first, pair.second))
        merge(pair.first, pair.second, *normal);
    }
    return result();
  }

 private:
  struct Pair {
    std::uint32_t first, second, first_version, second_version;
  };

  void fill_clusters() {
    for (std::size_t i = 0; i < clusters_.size(); ++i) clusters_[i].plane_normal = rough_.normals[i];
    for (std::uint32_t element = 0; element < graph_.size(); ++element) {
      const std::uint32_t patch = rough_.patch_of[element];
      if (patch == kNoPatch) continue;
      Cluster& cluster = clusters_[patch];
      cluster.elements.push_back(element);
      cluster.area += graph_.areas[element];
      cluster.normal_sum += graph_.areas[element] * graph_.normals[element];
      for (const Adjacency& side : graph_.neighbours(element)) {
        const std::uint32_t other = rough_.patch_of[side.element];
        if (other != kNoPatch && other != patch) cluster.neighbours.insert(other);
      }
    }
  }

  void propose(std::uint32_t a, std::uint32_t b) {
    const Pair pair{std::min(a, b), std::max(a, b), clusters_[std::min(a, b)].version,
                    clusters_[std::max(a, b)].version};
    pairs_.emplace(std::tuple(growth(clusters_[a], clusters_[b]), pair.first, pair.second), pair);
  }

  // The normal of a plane over which the union is a height field, if there is one.
  std::optional<Eigen::Vector3d> plane_of_union(std::uint32_t a, std::uint32_t b) {
    std::vector<Eigen::Vector3d> normals;
    for (const std::uint32_t cluster : {a, b})
      for (const std::uint32_t element : clusters_[cluster].elements) normals.push_back(graph_.normals[element]);
    const NormalCone cone = normal_cone(normals);
    if (cone.aperture_cosine < aperture_cosine_) return std::nullopt;
    if (!options_.strict) return cone.axis;
    SheetMap sheets(footprints_);
    const std::uint32_t sheet = sheets.add_patch(cone.axis);
    for (const std::uint32_t cluster : {a, b})
      for (const std::uint32_t element : clusters_[cluster].elements)
        if (!sheets.try_add(element, sheet)) return std::nullopt;
    return cone.axis;
  }

  void merge(std::uint32_t into, std::uint32_t from, const Eigen::Vector3d& normal) {
    Cluster &target = clusters_[into], &source = clusters_[from];
    target.elements.insert(target.elements.end(), source.elements.begin(), source.elements.end());
    target.area += source.area;
    target.normal_sum += source.normal_sum;
    target.plane_normal = normal;
    target.neighbours.insert(source.neighbours.begin(), source.neighbours.end());
    for (const std::uint32_t neighbour : source.neighbours) {
      clusters_[neighbour].neighbours.erase(from);
      if (neighbour != into) clusters_[neighbour].neighbours.insert(into);
    }
    target.neighbours.erase(into);
    target.neighbours.erase(from);
    ++target.version;
    source = {.elements = {}, .neighbours = {}, .version = source.version + 1};
    --remaining_;
    for (const std::uint32_t neighbour : target.neighbours) propose(into, neighbour);
  }

  RoughPartition result() {
    RoughPartition merged;
    merged.patch_of.assign(graph_.size(), kNoPatch);
    for (const Cluster& cluster : clusters_) {
      if (cluster.elements.empty()) continue;
      const auto patch = static_cast<std::uint32_t>(merged.normals.size());
      merged.normals.push_back(cluster.plane_normal);
      merged.seeds.push_back(
          *std::max_element(cluster.elements.begin(), cluster.elements.end(), [&](std::uint32_t a, std::uint32_t b) {
            const double cosine_a = graph_.normals[a].dot(cluster.plane_normal);
            const double cosine_b = graph_.normals[b].dot(cluster.plane_normal);
            return cosine_a != cosine_b ? cosine_a < cosine_b : a > b;
          }));
      for (const std::uint32_t element : cluster.elements) merged.patch_of[element] = patch;
    }
    return merged;
  }

  const ElementGraph& graph_;
  const Footprints& footprints_;
  RoughPartition rough_;
  const MergingOptions& options_;
  double aperture_cosine_;
  std::vector<Cluster> clusters_;
  std::size_t remaining_;
  std::map<std::tuple<double, std::uint32_t, std::uint32_t>, Pair> pairs_;  // by growth
};

}  // namespace

RoughPartition merge_patches(const ElementGraph& graph, const Footprints& footprints, RoughPartition rough,
                             const MergingOptions& options) {
  return Merging(graph, footprints, std::move(rough), options).run();
}

}  // namespace emap
