#include "libemap/partition/lloyd_partition.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "libemap/partition/components.h"
#include "libemap/partition/flooding.h"

namespace emap {
namespace {

constexpr int kIterations = 4;            // of flooding and fitting between seedings
constexpr double kConverged = 0.005;      // share of elements that still change their patch
constexpr double kLeastSeedShare = 1e-4;  // of the area: smaller leftovers get no seed here
constexpr double kSeedsPerRound = 0.34;   // at most, per patch that there is

class Lloyd {
 public:
  Lloyd(const ElementGraph& graph, const Footprints& footprints, const LloydOptions& options)
      : graph_(graph),
        footprints_(footprints),
        options_(options),
        aperture_cosine_(std::cos(options.aperture_degrees * std::numbers::pi / 180)),
        area_(graph.total_area()) {}

  RoughPartition run() {
    if (graph_.size() == 0) return {};
    add_seed(first_seed());
    for (int round = 0; round < options_.rounds; ++round) {
      iterate();
      if (!add_seeds()) break;
    }
    return std::move(rough_);
  }

 private:
  std::uint32_t first_seed() const {
    return static_cast<std::uint32_t>(
        std::distance(graph_.areas.begin(), std::max_element(graph_.areas.begin(), graph_.areas.end())));
  }

  void add_seed(std::uint32_t element) {
    const Eigen::Vector3d& normal = graph_.normals[element];
    rough_.seeds.push_back(element);
    rough_.normals.push_back(normal.isZero(0) ? Eigen::Vector3d::UnitZ() : normal);
  }

  void iterate() {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const std::vector<std::uint32_t> before = rough_.patch_of;
      flood_from_seeds();
      if (iteration + 1 == kIterations || share_changed(before) < kConverged) break;
      fit_planes();
    }
  }

  void flood_from_seeds() {
    SheetMap sheets(footprints_);
    rough_.patch_of.assign(graph_.size(), kNoPatch);
    for (std::uint32_t patch = 0; patch < rough_.seeds.size(); ++patch) {
      sheets.add_patch(rough_.normals[patch]);
      sheets.try_add(rough_.seeds[patch], patch);
      rough_.patch_of[rough_.seeds[patch]] = patch;
    }
    flood(graph_, {.aperture_cosine = aperture_cosine_}, sheets, rough_.patch_of);
  }

  double share_changed(const std::vector<std::uint32_t>& before) const {
    if (before.empty()) return 1;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != rough_.patch_of[i];
    return static_cast<double>(changed) / static_cast<double>(before.size());
  }

  // Normals by area-weighted means, which minimise J; seeds by the nearest normal, nearer the middle where it counts.
  void fit_planes() {
    const std::size_t count = rough_.seeds.size();
    std::vector<Eigen::Vector3d> sums(count, Eigen::Vector3d::Zero()), centres(count, Eigen::Vector3d::Zero());
    std::vector<double> areas(count, 0);
    for (std::size_t i = 0; i < graph_.size(); ++i) {
      const std::uint32_t patch = rough_.patch_of[i];
      if (patch == kNoPatch) continue;
      sums[patch] += graph_.areas[i] * graph_.normals[i];
      centres[patch] += graph_.areas[i] * graph_.centres[i];
      areas[patch] += graph_.areas[i];
    }
    for (std::size_t patch = 0; patch < count; ++patch) {
      if (const double length = sums[patch].norm(); length > 0) rough_.normals[patch] = sums[patch] / length;
      if (areas[patch] > 0) centres[patch] /= areas[patch];
    }
    std::vector<double> best(count, std::numeric_limits<double>::infinity());
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      const std::uint32_t patch = rough_.patch_of[i];
      if (patch == kNoPatch) continue;
      const double misfit = (graph_.normals[i] - rough_.normals[patch]).squaredNorm() +
                            (graph_.centres[i] - centres[patch]).squaredNorm() / (areas[patch] + 1e-300);
      if (misfit < best[patch]) best[patch] = misfit, rough_.seeds[patch] = i;
    }
  }

  // Seeds in the largest leftovers; where nothing is left but patches are too few, in the patches that fit worst.
  // Returns whether there was need of any.
  bool add_seeds() {
    std::vector<Component> leftovers = components_of(graph_, rough_.patch_of, kNoPatch);
    std::erase_if(leftovers, [&](const Component& c) { return c.area < kLeastSeedShare * area_; });
    std::stable_sort(leftovers.begin(), leftovers.end(),
                     [](const Component& a, const Component& b) { return a.area > b.area; });
    const std::size_t most = 1 + static_cast<std::size_t>(kSeedsPerRound * static_cast<double>(rough_.seeds.size()));
    for (std::size_t i = 0; i < std::min(most, leftovers.size()); ++i) add_seed(seed_in(leftovers[i].elements));
    if (!leftovers.empty()) return true;
    return split_worst_patches(most);
  }

  // The element whose normal is nearest to the mean of the leftover.
  std::uint32_t seed_in(const std::vector<std::uint32_t>& elements) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t element : elements) mean += graph_.areas[element] * graph_.normals[element];
    if (mean.norm() > 0) mean.normalize();
    return *std::min_element(elements.begin(), elements.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double misfit_a = (graph_.normals[a] - mean).squaredNorm(),
                   misfit_b = (graph_.normals[b] - mean).squaredNorm();
      return misfit_a != misfit_b ? misfit_a < misfit_b : a < b;
    });
  }

  bool split_worst_patches(std::size_t most) {
    const std::size_t count = rough_.seeds.size();
    if (count >= static_cast<std::size_t>(std::max(options_.least_patches, 0))) return false;
    std::vector<double> distortion(count, 0), worst(count, -1);
    std::vector<std::uint32_t> worst_element(count, kNoPatch);
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      const std::uint32_t patch = rough_.patch_of[i];
      if (patch == kNoPatch || i == rough_.seeds[patch]) continue;
      const double misfit = (graph_.normals[i] - rough_.normals[patch]).squaredNorm();
      distortion[patch] += misfit * graph_.areas[i];
      if (misfit > worst[patch]) worst[patch] = misfit, worst_element[patch] = i;
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return distortion[a] > distortion[b]; });
    bool added = false;
    most = std::min(most, static_cast<std::size_t>(options_.least_patches) - count);
    for (std::size_t i = 0; i < order.size() && most > 0; ++i) {
      if (worst_element[order[i]] == kNoPatch) continue;
      add_seed(worst_element[order[i]]);
      added = true;
      --most;
    }
    return added;
  }

  const ElementGraph& graph_;
  const Footprints& footprints_;
  const LloydOptions& options_;
  double aperture_cosine_, area_;
  RoughPartition rough_;
};

}  // namespace

RoughPartition lloyd_partition(const ElementGraph& graph, const Footprints& footprints, const LloydOptions& options) {
  return Lloyd(graph, footprints, options).run();
}

}  // namespace emap
