#include "libthin/estimation/removal_sums.h"

#include <cassert>

#include "libthin/estimation/lanes.h"

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

struct Row {
  const double* mean;
  const double* deviation;
  double weight_sum;
  std::uint32_t size;
  std::uint32_t* observation;
  double* weight;
  double* change;
};

// The inner loop of full updating: the row compacted to its retained pairs, the change that each of them would cause
// made right, and the increments moved by the differences. Returns how many are retained. Width is known to the
// compiler, or 0.
template <std::size_t Width>
inline __attribute__((always_inline)) std::uint32_t refresh_pairs(const Row& row, const std::uint8_t* retained,
                                                                  const double* values, double* increments,
                                                                  std::size_t any_width) {
  const std::size_t width = Width ? Width : any_width;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < row.size; ++i) {
    const std::uint32_t p = row.observation[i];
    if (!retained[p]) continue;
    const double weight = row.weight[i];
    const double a = weight / (row.weight_sum - weight);
    const double now = change(row.mean, row.deviation, values + p * width, width, a);
    increments[p] += now - row.change[i];
    row.observation[kept] = p;
    row.weight[kept] = weight;
    row.change[kept] = now;
    ++kept;
  }
  return kept;
}

THIN_VECTOR_CLONES std::uint32_t refresh_pairs(const Row& row, const std::uint8_t* retained, const double* values,
                                               double* increments, std::size_t width) {
  switch (width) {
    case 4:
      return refresh_pairs<4>(row, retained, values, increments, width);
    case 8:
      return refresh_pairs<8>(row, retained, values, increments, width);
    case 12:
      return refresh_pairs<12>(row, retained, values, increments, width);
    case 16:
      return refresh_pairs<16>(row, retained, values, increments, width);
    default:
      return refresh_pairs<0>(row, retained, values, increments, width);
  }
}

}  // namespace

RemovalSums::RemovalSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels)
    : width_(padded(channels)),
      values_(pad_rows(values, channels)),
      pair_observation_(std::move(table.observation)),
      pair_weight_(std::move(table.weight)),
      column_begin_(std::move(table.column_begin)),
      column_point_(std::move(table.evaluation_point)),
      column_weight_(std::move(table.column_weight)),
      increments_(column_begin_.size() - 1, 0.0),
      retained_(column_begin_.size() - 1, 1),
      marked_at_(column_begin_.size() - 1, 0) {
  const std::size_t points = table.row_begin.size() - 1;
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
  for (std::uint64_t i = point.row_begin; i < point.row_begin + point.row_size; ++i) {
    const std::uint32_t p = pair_observation_[i];
    if (!retained_[p]) continue;
    point.weight_sum += pair_weight_[i];
    for (std::size_t c = 0; c < width_; ++c) sums[c] += pair_weight_[i] * values_[p * width_ + c];
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

void RemovalSums::refresh_row(std::size_t q) {
  Point& point = points_[q];
  const std::uint64_t first = point.row_begin;
  if (point.retained_count > 1) {
    const Row row{&means_[q * width_],       &deviations_[q * width_], point.weight_sum,    point.row_size,
                  &pair_observation_[first], &pair_weight_[first],     &pair_change_[first]};
    point.row_size = refresh_pairs(row, retained_.data(), values_.data(), increments_.data(), width_);
  } else {
    refresh_short_row(q);
  }
  assert(point.row_size == point.retained_count);
}

// At most one pair left: taking it out leaves the estimate 0.
void RemovalSums::refresh_short_row(std::size_t q) {
  Point& point = points_[q];
  for (std::uint64_t i = point.row_begin; i < point.row_begin + point.row_size; ++i) {
    const std::uint32_t p = pair_observation_[i];
    if (!retained_[p]) continue;
    const double now = pair_change(q, p, pair_weight_[i]);
    increments_[p] += now - pair_change_[i];
    pair_observation_[point.row_begin] = p;
    pair_weight_[point.row_begin] = pair_weight_[i];
    pair_change_[point.row_begin] = now;
  }
  point.row_size = point.retained_count;
}

void RemovalSums::mark_row(std::size_t q, std::vector<std::uint32_t>& changed) {
  const Point& point = points_[q];
  for (std::uint64_t i = point.row_begin; i < point.row_begin + point.row_size; ++i) {
    const std::uint32_t p = pair_observation_[i];
    if (marked_at_[p] == step_) continue;
    marked_at_[p] = step_;
    changed.push_back(p);
  }
}

void RemovalSums::track_increments() {
  pair_change_.assign(pair_observation_.size(), 0.0);
  std::fill(increments_.begin(), increments_.end(), 0.0);
  for (std::size_t q = 0; q < points_.size(); ++q) refresh_row(q);
}

void RemovalSums::remove(std::uint32_t p, std::vector<std::uint32_t>* changed) {
  assert(is_retained(p));
  retained_[p] = 0;
  ++step_;
  for (std::uint64_t entry = column_begin_[p]; entry < column_begin_[p + 1]; ++entry) {
    const std::uint32_t q = column_point_[entry];
    take_out(q, p, column_weight_[entry]);
    if (!changed) continue;
    refresh_row(q);
    mark_row(q, *changed);
  }
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
