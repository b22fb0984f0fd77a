#include "libemap/partition/flooding.h"

#include <algorithm>
#include <cmath>

#include "libthin/foundation/indexed_priority_queue.h"

namespace emap {
namespace {

// Comes before every squared distance between unit normals.
constexpr double kFixedFirst = -8;

struct Fit {
  double least_cosine;      // of the widest angle between the element's normals and the plane's
  double distance_squared;  // between its mean normal and the plane's
};

Fit fit_of(const ElementGraph& graph, std::uint32_t element, const Eigen::Vector3d& normal) {
  if (graph.normals[element].isZero(0)) return {1, 1};
  const double cosine = graph.normals[element].dot(normal);
  if (graph.spread_cosines.empty()) return {cosine, 2 - 2 * cosine};
  // cos(a + b); at most a half turn.
  const double spread = graph.spread_cosines[element];
  const double sines = std::sqrt(std::max(0.0, (1 - cosine * cosine) * (1 - spread * spread)));
  return {cosine <= -spread ? -1 : cosine * spread - sines, 2 - 2 * cosine};
}

class Flood {
 public:
  Flood(const ElementGraph& graph, const FloodingRules& rules, SheetMap& sheets, std::vector<std::uint32_t>& patch_of)
      : graph_(graph),
        rules_(rules),
        sheets_(sheets),
        patch_of_(patch_of),
        candidate_(graph.size(), kNoPatch),
        queue_(graph.size()) {}

  void run() {
    for (std::uint32_t element = 0; element < graph_.size(); ++element)
      if (patch_of_[element] != kNoPatch) offer_to_neighbours(element);
    while (!queue_.empty()) {
      const double cost = queue_.top_key();
      const std::uint32_t element = queue_.pop();
      if (sheets_.try_add(element, candidate_[element], rules_.leniency)) {
        patch_of_[element] = candidate_[element];
        offer_to_neighbours(element);
      } else {
        queue_next_choice(element, cost);
      }
    }
  }

 private:
  // Squared distance of the normals; infinite where the rules forbid the patch.
  double cost(std::uint32_t element, std::uint32_t patch) const {
    const bool is_fixed = !rules_.fixed.empty() && rules_.fixed[element] != kNoPatch;
    if (is_fixed && rules_.fixed[element] != patch) return std::numeric_limits<double>::infinity();
    const Fit fit = fit_of(graph_, element, sheets_.normal(patch));
    if (fit.least_cosine < rules_.aperture_cosine) return std::numeric_limits<double>::infinity();
    return fit.distance_squared + (is_fixed ? kFixedFirst : 0);
  }

  void offer_to_neighbours(std::uint32_t element) {
    const std::uint32_t patch = patch_of_[element];
    for (const Adjacency& neighbour : graph_.neighbours(element))
      if (patch_of_[neighbour.element] == kNoPatch) offer(neighbour.element, patch);
  }

  void offer(std::uint32_t element, std::uint32_t patch) {
    if (queue_.contains(element) && candidate_[element] == patch) return;
    const double offered = cost(element, patch);
    if (!std::isfinite(offered)) return;
    if (!queue_.contains(element)) {
      candidate_[element] = patch;
      queue_.push(element, offered);
    } else if (offered < queue_.key(element) || (offered == queue_.key(element) && patch < candidate_[element])) {
      candidate_[element] = patch;
      queue_.update(element, offered);
    }
  }

  // After a refusal: the best of the patches around that comes after the refused one by (cost, number).
  void queue_next_choice(std::uint32_t element, double refused_cost) {
    const std::uint32_t refused = candidate_[element];
    double best_cost = std::numeric_limits<double>::infinity();
    std::uint32_t best = kNoPatch;
    for (const Adjacency& neighbour : graph_.neighbours(element)) {
      const std::uint32_t patch = patch_of_[neighbour.element];
      if (patch == kNoPatch || patch == refused) continue;
      const double offered = cost(element, patch);
      if (offered < refused_cost || (offered == refused_cost && patch < refused)) continue;
      if (offered < best_cost || (offered == best_cost && patch < best)) best_cost = offered, best = patch;
    }
    if (!std::isfinite(best_cost)) return;
    candidate_[element] = best;
    queue_.push(element, best_cost);
  }

  const ElementGraph& graph_;
  const FloodingRules& rules_;
  SheetMap& sheets_;
  std::vector<std::uint32_t>& patch_of_;
  std::vector<std::uint32_t> candidate_;  // the patch to which a queued element would go
  thin::IndexedPriorityQueue<double> queue_;
};

}  // namespace

double least_cosine(const ElementGraph& graph, std::uint32_t element, const Eigen::Vector3d& normal) {
  return fit_of(graph, element, normal).least_cosine;
}

void flood(const ElementGraph& graph, const FloodingRules& rules, SheetMap& sheets,
           std::vector<std::uint32_t>& patch_of) {
  Flood(graph, rules, sheets, patch_of).run();
}

}  // namespace emap
