#pragma once

// The greedy halves of estimation error analysis: by removal from the full set (thesis 6.3.2, 6.3.3), and by insertion
// into the empty one (6.3.4), by which analysis thinning begins too. At each step the observation is taken whose change
// of state raises the error least.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libthin/estimation/estimation_sums.h"
#include "libthin/estimation/local_analysis.h"
#include "libthin/thinning/increment_queue.h"
#include "libthin/thinning/separation.h"

namespace thin {

struct GreedyGoal {
  std::size_t retain_count = 0;           // removal ends with so many, insertion too
  std::optional<double> error_sum = {};   // |Q| E: removal ends before it would be passed, insertion once it is reached
  std::span<const double> priority = {};  // n, or empty: lower ones are removed first, higher ones inserted first
  const Separation* separation = nullptr;  // removal ends with fewer than retain_count where this asks for it
};

// Removes from `sums` (started with all). `order`, if given, receives the removed in order.
// First, of those that stand too near to others, the one whose loss matters least, until none do; then of all.
// Full: O(sum over removals of the pairs of the points within reach). Lazy: less by an order of magnitude.
void remove_greedily(EstimationSums& sums, const GreedyGoal& goal, Update update,
                     std::vector<std::uint32_t>* order = nullptr);

// Inserts into `sums` (started with none): EstimationSums or LocalAnalysis, whose J is the error then. `order`, if
// given, receives the inserted in order.
template <class Sums>
void insert_greedily(Sums& sums, const GreedyGoal& goal, Update update, std::vector<std::uint32_t>* order = nullptr);

}  // namespace thin
