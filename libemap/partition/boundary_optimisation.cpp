#include "libemap/partition/boundary_optimisation.h"

#include <algorithm>
#include <array>
#include <optional>

#include "libemap/partition/flooding.h"
#include "libthin/foundation/indexed_priority_queue.h"

namespace emap {
namespace {

// One or two elements of one patch that would go over to another.
struct Move {
  std::uint32_t first = kNoPatch, second = kNoPatch;  // second: kNoPatch where it is one element
  std::uint32_t target = kNoPatch;
  double gain = 0;
};

class BoundaryOptimiser {
 public:
  BoundaryOptimiser(const ElementGraph& graph, double aperture_cosine, SheetMap& sheets,
                    std::vector<std::uint32_t>& patch_of)
      : graph_(graph),
        aperture_cosine_(aperture_cosine),
        sheets_(sheets),
        patch_of_(patch_of),
        moves_(graph.size()),
        queue_(graph.size()) {}

  double run() {
    for (std::uint32_t element = 0; element < graph_.size(); ++element) consider(element);
    double total = 0;
    while (!queue_.empty()) {
      const std::uint32_t element = queue_.pop();
      const Move move = moves_[element];
      if (!still_good(move) || !apply(move)) continue;
      total += move.gain;
      consider_around(move.first);
      if (move.second != kNoPatch) consider_around(move.second);
    }
    return total;
  }

 private:
  // Puts the element's best move into the queue, where it gains anything.
  void consider(std::uint32_t element) {
    Move best;
    visit_moves(element, [&](const Move& move) {
      if (move.gain > best.gain || (move.gain == best.gain && move.gain > 0 && move.target < best.target)) best = move;
    });
    const double least_gain = 1e-6 * static_cast<double>(graph_.neighbours(element).size());
    const bool worthwhile = best.gain > least_gain * mean_length(element);
    if (queue_.contains(element)) queue_.erase(element);
    if (!worthwhile) return;
    moves_[element] = best;
    queue_.push(element, -best.gain);
  }

  double mean_length(std::uint32_t element) const {
    double sum = 0;
    for (const Adjacency& neighbour : graph_.neighbours(element)) sum += neighbour.boundary_length;
    return graph_.neighbours(element).empty() ? 0 : sum / static_cast<double>(graph_.neighbours(element).size());
  }

  template <class Visitor>
  void visit_moves(std::uint32_t element, const Visitor& visit) const {
    for (const Adjacency& side : graph_.neighbours(element)) {
      const std::uint32_t target = patch_of_[side.element];
      if (target == patch_of_[element]) continue;
      visit(move_of(element, kNoPatch, target));
      for (const Adjacency& partner : graph_.neighbours(element))
        if (patch_of_[partner.element] == patch_of_[element]) visit(move_of(element, partner.element, target));
    }
  }

  Move move_of(std::uint32_t first, std::uint32_t second, std::uint32_t target) const {
    Move move{first, second, target, 0};
    int sides_kept = 0;
    for (const std::uint32_t element : {first, second}) {
      if (element == kNoPatch) continue;
      for (const Adjacency& side : graph_.neighbours(element)) {
        if (side.element == first || side.element == second) continue;
        if (patch_of_[side.element] == target) move.gain += side.boundary_length;
        if (patch_of_[side.element] == patch_of_[first]) move.gain -= side.boundary_length, ++sides_kept;
      }
    }
    if (sides_kept != 1 && !stays_connected(move)) move.gain = -1;
    return move;
  }

  // Whether what remains of the old patch around the moved elements hangs together by itself, over the neighbours of
  // the moved ones and theirs; and is there at all, for a patch must not vanish.
  bool stays_connected(const Move& move) const {
    std::vector<std::uint32_t> rest, reached;
    for (const std::uint32_t element : {move.first, move.second}) {
      if (element == kNoPatch) continue;
      for (const Adjacency& side : graph_.neighbours(element))
        if (remains(side.element, move)) rest.push_back(side.element);
    }
    if (rest.empty()) return false;
    std::sort(rest.begin(), rest.end());
    rest.erase(std::unique(rest.begin(), rest.end()), rest.end());
    reached.push_back(rest.front());
    const auto add = [&](std::uint32_t element) {
      if (std::find(reached.begin(), reached.end(), element) == reached.end()) reached.push_back(element);
    };
    for (std::size_t next = 0; next < reached.size(); ++next)
      for (const Adjacency& side : graph_.neighbours(reached[next])) {
        if (!remains(side.element, move)) continue;
        const bool is_rest = std::binary_search(rest.begin(), rest.end(), side.element);
        // One step beyond the direct neighbours, but not from there on.
        if (is_rest || std::binary_search(rest.begin(), rest.end(), reached[next])) add(side.element);
      }
    return std::all_of(rest.begin(), rest.end(), [&](std::uint32_t element) {
      return std::find(reached.begin(), reached.end(), element) != reached.end();
    });
  }

  bool remains(std::uint32_t element, const Move& move) const {
    return element != move.first && element != move.second && patch_of_[element] == patch_of_[move.first];
  }

  bool still_good(const Move& move) const {
    if (patch_of_[move.first] == move.target) return false;
    if (move.second != kNoPatch && patch_of_[move.second] != patch_of_[move.first]) return false;
    return move_of(move.first, move.second, move.target).gain == move.gain;
  }

  bool apply(const Move& move) {
    for (const std::uint32_t element : {move.first, move.second})
      if (element != kNoPatch && least_cosine(graph_, element, sheets_.normal(move.target)) < aperture_cosine_)
        return false;
    // A cell that the first of a pair has taken when the second is refused stays taken: that only forbids, it never
    // allows.
    if (!sheets_.try_add(move.first, move.target)) return false;
    if (move.second != kNoPatch && !sheets_.try_add(move.second, move.target)) return false;
    patch_of_[move.first] = move.target;
    if (move.second != kNoPatch) patch_of_[move.second] = move.target;
    return true;
  }

  void consider_around(std::uint32_t element) {
    consider(element);
    for (const Adjacency& side : graph_.neighbours(element)) {
      consider(side.element);
      for (const Adjacency& next : graph_.neighbours(side.element)) consider(next.element);
    }
  }

  const ElementGraph& graph_;
  double aperture_cosine_;
  SheetMap& sheets_;
  std::vector<std::uint32_t>& patch_of_;
  std::vector<Move> moves_;  // the best of each element in the queue
  thin::IndexedPriorityQueue<double> queue_;
};

}  // namespace

double optimise_boundaries(const ElementGraph& graph, double aperture_cosine, SheetMap& sheets,
                           std::vector<std::uint32_t>& patch_of) {
  return BoundaryOptimiser(graph, aperture_cosine, sheets, patch_of).run();
}

double boundary_length(const ElementGraph& graph, const std::vector<std::uint32_t>& patch_of) {
  double length = 0;
  for (std::uint32_t element = 0; element < graph.size(); ++element)
    for (const Adjacency& side : graph.neighbours(element))
      if (element < side.element && patch_of[element] != patch_of[side.element]) length += side.boundary_length;
  return length;
}

}  // namespace emap
