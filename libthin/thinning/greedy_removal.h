#pragma once

// Estimation error analysis by removal (thesis 6.3.2, 6.4.2): from the full set, take out the observation whose loss
// raises the estimation error least, until few enough are left.

#include "libthin/estimation/removal_sums.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

enum class Update {
  full,  // every increment that a removal changed is made right before the next choice: each step is the true minimum
  lazy,  // an increment is made right only when its observation reaches the front of the queue
};

// Removes observations from `sums` until `retain_count` are left. `removed`, if given, receives them in order.
// Full: O(sum over removals of the pairs of the evaluation points within reach). Lazy: less by an order of magnitude.
Retained remove_greedily(RemovalSums& sums, std::size_t retain_count, Update update,
                         std::vector<std::uint32_t>* removed = nullptr);

}  // namespace thin
