#pragma once

// Who counts for whom in the Gaussian filter: the weights between evaluation points and observations, as a
// compressed-sparse-row table by evaluation point, and the same entries by observation.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libthin/estimation/gaussian_filter.h"
#include "libthin/estimation/places.h"
#include "libthin/foundation/memory.h"
#include "libthin/foundation/result.h"

namespace thin {

struct NeighbourhoodTable {
  // By evaluation point q: entries row_begin[q] .. row_begin[q+1], by ascending observation.
  std::vector<std::uint64_t> row_begin;
  std::vector<std::uint32_t> observation;
  std::vector<double> weight;

  // By observation p: entries column_begin[p] .. column_begin[p+1], by ascending evaluation point. Empty where the
  // evaluation points are the observations: then the table is symmetric, and column p is row p.
  std::vector<std::uint64_t> column_begin;
  std::vector<std::uint32_t> column_point;
  std::vector<double> column_weight;

  std::size_t observations = 0;

  std::size_t evaluation_point_count() const { return row_begin.size() - 1; }
  std::size_t observation_count() const { return observations; }
  std::size_t entry_count() const { return observation.size(); }
  bool is_symmetric() const { return column_begin.empty(); }

  // The evaluation points within reach of observation p.
  std::span<const std::uint32_t> points_near(std::size_t p) const {
    const auto& begin = is_symmetric() ? row_begin : column_begin;
    return std::span(is_symmetric() ? observation : column_point).subspan(begin[p], begin[p + 1] - begin[p]);
  }
};

// What the estimation error analysis needs for each entry at its largest, table and sums together.
constexpr std::uint64_t kBytesPerEntry = 40;

// The table for these places; its rows are the evaluation points with at least one observation of their group within
// filter.radius_km(), in their order, and `kept_points` (if given) lists which these were.
// O((|Q| + entries) log n), on all cores; the result does not depend on their number.
// Errors: configuration, where the entries (estimated from a sample first) would take more than `memory_bytes`, or are
// more than 2^32 - 1, with the remedy.
Result<NeighbourhoodTable> neighbourhood_table(const Places& evaluation_points, const Places& observations,
                                               const GaussianFilter& filter,
                                               std::vector<std::uint32_t>* kept_points = nullptr,
                                               std::uint64_t memory_bytes = available_memory_bytes());

// The same with the observations as evaluation points.
Result<NeighbourhoodTable> neighbourhood_table(const Places& observations, const GaussianFilter& filter,
                                               std::uint64_t memory_bytes = available_memory_bytes());

// The rows alone, every one kept, without columns and without asking for the memory first: for those who have done so.
Result<NeighbourhoodTable> neighbourhood_rows(const Places& evaluation_points, const Places& observations,
                                              const GaussianFilter& filter);

// Calls body(q, observations within reach of q in ascending order, their weights) for each evaluation point, on all
// cores, without keeping a table. REQUIRES: bodies of different q may run at the same time
using NeighbourhoodBody =
    std::function<void(std::uint32_t q, std::span<const std::uint32_t> observations, std::span<const double> weights)>;
void each_neighbourhood(const Places& evaluation_points, const Places& observations, const GaussianFilter& filter,
                        const NeighbourhoodBody& body);

}  // namespace thin
