#include "libthin/estimation/removal_sums.h"

#include <cassert>

#include "libthin/estimation/lanes.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

inline __attribute__((always_inline)) double squared_norm(const double* x, std::size_t width) {
  Lanes sum{};
  for (std::size_t c = 0; c < width; c += kLaneCount) sum += load(x + c) * load(x + c);
  return across(sum);
}

// 2a d.(m - f) + a² |m - f|²
inline __attribute__((always_inline)) double change(const double* mean, const double* deviation, const double* value,
                                                    std::size_t width, double a) {
  Lanes along{}, squared{};
  for (std::size_t c = 0; c < width; c += kLaneCount) {
    const Lanes difference = load(mean + c) - load(value + c);
    along += load(deviation + c) * difference;
    squared += difference * difference;
  }
  return a * (2 * across(along) + a * across(squared));
}

struct RowView {
  const double* mean;
  const double* deviation;
  double weight_sum;
};

// The inner loop of full updating: the change that each retained pair of one row would cause, into its cache place, and
// the row compacted to its retained pairs. Returns how many these are. Width is known to the compiler, or 0.
template <std::size_t Width, class Pair>
inline __attribute__((always_inline)) std::uint32_t refresh_pairs(const RowView& row, Pair* pairs, std::uint32_t size,
                                                                  const std::uint8_t* retained, const double* values,
                                                                  double* cache, std::size_t any_width) {
  const std::size_t width = Width ? Width : any_width;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < size; ++i) {
    const Pair pair = pairs[i];
    if (!retained[pair.observation]) continue;
    pairs[kept++] = pair;
    const double a = pair.weight / (row.weight_sum - pair.weight);
    cache[pair.column_entry] = change(row.mean, row.deviation, values + pair.observation * width, width, a);
  }
  return kept;
}

template <class Pair>
THIN_VECTOR_CLONES std::uint32_t refresh_pairs(const RowView& row, Pair* pairs, std::uint32_t size,
                                               const std::uint8_t* retained, const double* values, double* cache,
                                               std::size_t width) {
  switch (width) {
    case 4:
      return refresh_pairs<4>(row, pairs, size, retained, values, cache, width);
    case 8:
      return refresh_pairs<8>(row, pairs, size, retained, values, cache, width);
    case 12:
      return refresh_pairs<12>(row, pairs, size, retained, values, cache, width);
    case 16:
      return refresh_pairs<16>(row, pairs, size, retained, values, cache, width);
    default:
      return refresh_pairs<0>(row, pairs, size, retained, values, cache, width);
  }
}

}  // namespace

RemovalSums::RemovalSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels)
    : width_(padded(channels)),
      values_(pad_rows(values, channels)),
      column_begin_(std::move(table.column_begin)),
      column_point_(std::move(table.evaluation_point)),
      column_weight_(std::move(table.column_weight)),
      retained_(column_begin_.size() - 1, 1),
      marked_at_(column_begin_.size() - 1, 0) {
  const std::size_t points = table.row_begin.size() - 1;
  pairs_.resize(table.observation.size());
  for (std::size_t entry = 0; entry < pairs_.size(); ++entry)
    pairs_[entry] = {table.observation[entry], table.column_entry[entry], table.weight[entry]};
  points_.resize(points);
  value_sums_.resize(points * width_);
  means_.resize(points * width_);
  deviations_.resize(points * width_);
  references_.assign(points * width_, 0.0);
  for (std::size_t q = 0; q < points; ++q) {
    const auto size = static_cast<std::uint32_t>(table.row_begin[q + 1] - table.row_begin[q]);
    points_[q] = {table.row_begin[q], size, size, 0, 0, 0};
    sum_afresh(q);
    update_means(q);
  }
  references_ = means_;
  std::fill(deviations_.begin(), deviations_.end(), 0.0);
}

void RemovalSums::sum_afresh(std::size_t q) {
  Point& point = points_[q];
  double* sums = value_sums_.data() + q * width_;
  std::fill(sums, sums + width_, 0.0);
  point.weight_sum = 0;
  for (std::uint32_t i = 0; i < point.row_size; ++i) {
    const Pair& pair = pairs_[point.row_begin + i];
    if (!retained_[pair.observation]) continue;
    point.weight_sum += pair.weight;
    for (std::size_t c = 0; c < width_; ++c) sums[c] += pair.weight * values_[pair.observation * width_ + c];
  }
  point.weight_sum_when_summed = point.weight_sum;
}

void RemovalSums::update_means(std::size_t q) {
  const Point& point = points_[q];
  for (std::size_t i = q * width_; i < (q + 1) * width_; ++i) {
    means_[i] = point.retained_count > 0 ? value_sums_[i] / point.weight_sum : 0.0;
    deviations_[i] = means_[i] - references_[i];
  }
}

void RemovalSums::take_out(std::size_t q, std::uint32_t p, double weight) {
  Point& point = points_[q];
  --point.retained_count;
  point.changed_at = step_;
  point.weight_sum -= weight;
  for (std::size_t c = 0; c < width_; ++c) value_sums_[q * width_ + c] -= weight * values_[p * width_ + c];
  if (point.weight_sum < 0.5 * point.weight_sum_when_summed) sum_afresh(q);
  update_means(q);
}

double RemovalSums::pair_change(std::size_t q, std::uint32_t p, double weight) const {
  const Point& point = points_[q];
  const std::size_t first = q * width_;
  if (point.retained_count == 1)
    return squared_norm(&references_[first], width_) - squared_norm(&deviations_[first], width_);
  return change(&means_[first], &deviations_[first], &values_[p * width_], width_,
                weight / (point.weight_sum - weight));
}

void RemovalSums::refresh_row(std::size_t q, std::vector<std::uint32_t>* changed) {
  Point& point = points_[q];
  Pair* row = &pairs_[point.row_begin];
  const RowView view{&means_[q * width_], &deviations_[q * width_], point.weight_sum};
  point.row_size =
      refresh_pairs(view, row, point.row_size, retained_.data(), values_.data(), column_change_.data(), width_);
  assert(point.row_size == point.retained_count);
  if (point.row_size == 1) column_change_[row->column_entry] = pair_change(q, row->observation, row->weight);
  if (!changed) return;
  for (std::uint32_t i = 0; i < point.row_size; ++i) {
    const std::uint32_t p = row[i].observation;
    if (marked_at_[p] == step_) continue;
    marked_at_[p] = step_;
    changed->push_back(p);
  }
}

void RemovalSums::fill_cache() {
  column_change_.assign(column_point_.size(), 0.0);
  parallel_ranges(points_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) refresh_row(q, nullptr);
  });
}

void RemovalSums::remove(std::uint32_t p, std::vector<std::uint32_t>* changed) {
  assert(is_retained(p));
  retained_[p] = 0;
  ++step_;
  for (std::uint64_t entry = column_begin_[p]; entry < column_begin_[p + 1]; ++entry) {
    const std::uint32_t q = column_point_[entry];
    take_out(q, p, column_weight_[entry]);
    if (changed) refresh_row(q, changed);
  }
}

double RemovalSums::cached_increment(std::uint32_t p) const {
  double sum = 0;
  for (std::uint64_t entry = column_begin_[p]; entry < column_begin_[p + 1]; ++entry) sum += column_change_[entry];
  return sum;
}

double RemovalSums::increment(std::uint32_t p) const {
  double sum = 0;
  for (std::uint64_t entry = column_begin_[p]; entry < column_begin_[p + 1]; ++entry)
    sum += pair_change(column_point_[entry], p, column_weight_[entry]);
  return sum;
}

bool RemovalSums::changed_since(std::uint32_t p, std::uint32_t step) const {
  for (std::uint64_t entry = column_begin_[p]; entry < column_begin_[p + 1]; ++entry)
    if (points_[column_point_[entry]].changed_at > step) return true;
  return false;
}

double RemovalSums::error_sum() const {
  double sum = 0;
  for (std::size_t q = 0; q < points_.size(); ++q) sum += squared_norm(&deviations_[q * width_], width_);
  return sum;
}

}  // namespace thin
