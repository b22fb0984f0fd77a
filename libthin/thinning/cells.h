#pragma once

// What methods that cut space into cells have in common: of each cell one observation is retained.

#include <algorithm>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "libthin/thinning/thinning_method.h"

namespace thin {

// Of each cell the observation that no other is better than; of several the first. cells: n numbers; is_better(a, b):
// whether a is to be retained rather than b. O(n).
template <class IsBetter>
Retained best_of_each_cell(std::span<const std::uint64_t> cells, const IsBetter& is_better) {
  std::unordered_map<std::uint64_t, std::uint32_t> best;
  best.reserve(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const auto [place, is_first] = best.try_emplace(cells[i], i);
    if (!is_first && is_better(i, place->second)) place->second = i;
  }
  Retained retained;
  retained.reserve(best.size());
  for (const auto& entry : best) retained.push_back(entry.second);
  std::sort(retained.begin(), retained.end());
  return retained;
}

// Of each cell the observation of highest priority, then the one with the least distance.
inline Retained nearest_of_each_cell(const ThinningInput& input, std::span<const std::uint64_t> cells,
                                     std::span<const double> distance) {
  return best_of_each_cell(cells, [&](std::uint32_t a, std::uint32_t b) {
    return input.has_priority(a, b) || (!input.has_priority(b, a) && distance[a] < distance[b]);
  });
}

}  // namespace thin
