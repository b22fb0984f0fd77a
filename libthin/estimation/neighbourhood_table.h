#pragma once

// Who counts for whom in the Gaussian filter: the weights between evaluation points and observations, as two
// compressed-sparse-row tables over the same entries, one by evaluation point, one by observation.

#include <cstdint>
#include <vector>

#include "libthin/estimation/gaussian_filter.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct NeighbourhoodTable {
  // By evaluation point q: entries row_begin[q] .. row_begin[q+1], by ascending observation.
  std::vector<std::uint64_t> row_begin;
  std::vector<std::uint32_t> observation;
  std::vector<double> weight;

  // By observation p: entries column_begin[p] .. column_begin[p+1], by ascending evaluation point.
  std::vector<std::uint64_t> column_begin;
  std::vector<std::uint32_t> evaluation_point;
  std::vector<double> column_weight;

  std::size_t evaluation_point_count() const { return row_begin.size() - 1; }
  std::size_t observation_count() const { return column_begin.size() - 1; }
  std::size_t entry_count() const { return observation.size(); }
};

// The table for these positions, km; its rows are the evaluation points with at least one observation within
// filter.radius_km(), in their order, and `kept_points` (if given) lists which these were.
// O((|Q| + entries) log n), on all cores; the result does not depend on their number.
// Errors: configuration, where there are more than 2^32 - 1 entries, with the remedy.
Result<NeighbourhoodTable> neighbourhood_table(std::span<const Vector3> evaluation_points,
                                               std::span<const Vector3> observations, const GaussianFilter& filter,
                                               std::vector<std::uint32_t>* kept_points = nullptr);

}  // namespace thin
