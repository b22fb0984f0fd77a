#include "libthin/estimation/estimation_sums.h"

#include <algorithm>
#include <cassert>

#include "libthin/estimation/lanes.h"

namespace thin {
namespace {

constexpr std::uint32_t kFreshAfter = 256;

inline __attribute__((always_inline)) double squared_norm(const double* x, std::size_t width) {
  Lanes sum{};
  for (std::size_t c = 0; c < width; c += kLaneCount) sum += load(x + c) * load(x + c);
  return across(sum);
}

// The change that moving the mean by a (m - f) makes to |m - reference|²:  2a d.(m - f) + a² |m - f|².
// a > 0: f is given up; a < 0: it is retained.
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
  const std::uint32_t* observation;
  const double* weight;
  double* change;
};

// The inner loop of full updating: the change that each pair would cause made right, and the increments moved by the
// differences. Width is known to the compiler, or 0.
template <std::size_t Width, bool Retained>
inline __attribute__((always_inline)) void refresh_pairs(const Row& row, const double* values, double* increments,
                                                         std::size_t any_width) {
  const std::size_t width = Width ? Width : any_width;
  for (std::uint32_t i = 0; i < row.size; ++i) {
    const std::uint32_t p = row.observation[i];
    const double weight = row.weight[i];
    const double a = Retained ? weight / (row.weight_sum - weight) : -weight / (row.weight_sum + weight);
    const double now = change(row.mean, row.deviation, values + p * width, width, a);
    increments[p] += now - row.change[i];
    row.change[i] = now;
  }
}

template <bool Retained>
inline __attribute__((always_inline)) void refresh_pairs(const Row& row, const double* values, double* increments,
                                                         std::size_t width) {
  switch (width) {
    case 4:
      return refresh_pairs<4, Retained>(row, values, increments, width);
    case 8:
      return refresh_pairs<8, Retained>(row, values, increments, width);
    case 12:
      return refresh_pairs<12, Retained>(row, values, increments, width);
    case 16:
      return refresh_pairs<16, Retained>(row, values, increments, width);
    default:
      return refresh_pairs<0, Retained>(row, values, increments, width);
  }
}

THIN_VECTOR_CLONES void refresh_retained(const Row& row, const double* values, double* increments, std::size_t width) {
  refresh_pairs<true>(row, values, increments, width);
}
THIN_VECTOR_CLONES void refresh_given_up(const Row& row, const double* values, double* increments, std::size_t width) {
  refresh_pairs<false>(row, values, increments, width);
}

}  // namespace

EstimationSums::EstimationSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels,
                               Start start)
    : width_(padded(channels)),
      values_(pad_rows(values, channels)),
      pair_observation_(std::move(table.observation)),
      pair_weight_(std::move(table.weight)),
      column_begin_(std::move(table.column_begin)),
      column_point_(std::move(table.column_point)),
      column_weight_(std::move(table.column_weight)),
      increments_(table.observations, 0.0),
      retained_(table.observations, 1),
      retained_count_(table.observations),
      marked_at_(table.observations, 0) {
  const std::size_t points = table.row_begin.size() - 1;
  points_.resize(points);
  value_sums_.resize(points * width_);
  means_.resize(points * width_);
  deviations_.resize(points * width_);
  references_.assign(points * width_, 0.0);
  for (std::size_t q = 0; q < points; ++q) {
    const auto size = static_cast<std::uint32_t>(table.row_begin[q + 1] - table.row_begin[q]);
    points_[q] = {table.row_begin[q], size, size, 0, 0, 0, 0};
    sum_afresh(q);
    update_mean(q);
  }
  references_ = means_;
  std::fill(deviations_.begin(), deviations_.end(), 0.0);
  if (start == Start::with_all) return;
  std::fill(retained_.begin(), retained_.end(), std::uint8_t{0});
  retained_count_ = 0;
  for (std::size_t q = 0; q < points; ++q) {
    points_[q].retained_count = 0;
    sum_afresh(q);
    update_mean(q);
  }
}

EstimationSums::Column EstimationSums::column(std::uint32_t p) const {
  if (column_begin_.empty()) return {&pair_observation_[points_[p].row_begin], &pair_weight_[points_[p].row_begin]};
  return {column_point_.data() + column_begin_[p], column_weight_.data() + column_begin_[p]};
}

std::size_t EstimationSums::column_size(std::uint32_t p) const {
  return column_begin_.empty() ? points_[p].row_size : column_begin_[p + 1] - column_begin_[p];
}

void EstimationSums::sum_afresh(std::size_t q) {
  Point& point = points_[q];
  double* sums = value_sums_.data() + q * width_;
  std::fill(sums, sums + width_, 0.0);
  point.weight_sum = 0;
  for (std::uint64_t i = point.row_begin; i < point.row_begin + point.retained_count; ++i) {
    const double* value = values_.data() + pair_observation_[i] * width_;
    point.weight_sum += pair_weight_[i];
    for (std::size_t c = 0; c < width_; ++c) sums[c] += pair_weight_[i] * value[c];
  }
  point.largest_weight_sum = point.weight_sum;
  point.updates = 0;
}

void EstimationSums::update_mean(std::size_t q) {
  const Point& point = points_[q];
  for (std::size_t i = q * width_; i < (q + 1) * width_; ++i) {
    means_[i] = point.retained_count > 0 ? value_sums_[i] / point.weight_sum : 0.0;
    deviations_[i] = means_[i] - references_[i];
  }
}

// Across the border between the retained and the others.
void EstimationSums::move_pair(std::size_t q, std::uint32_t p) {
  Point& point = points_[q];
  const bool to_front = retained_[p];
  const std::uint64_t begin = point.row_begin + (to_front ? point.retained_count : 0);
  const std::uint64_t place = static_cast<std::uint64_t>(
      std::find(pair_observation_.begin() + static_cast<std::ptrdiff_t>(begin), pair_observation_.end(), p) -
      pair_observation_.begin());
  const std::uint64_t border = point.row_begin + (to_front ? point.retained_count : point.retained_count - 1);
  std::swap(pair_observation_[place], pair_observation_[border]);
  std::swap(pair_weight_[place], pair_weight_[border]);
  if (track_ != Track::nothing) {
    std::swap(pair_change_[place], pair_change_[border]);
    pair_change_[border] = 0;
  }
  point.retained_count += to_front ? 1 : -1;
}

void EstimationSums::update_point(std::size_t q, std::uint32_t p, double weight) {
  move_pair(q, p);
  Point& point = points_[q];
  point.changed_at = step_;
  const double signed_weight = retained_[p] ? weight : -weight;
  point.weight_sum += signed_weight;
  point.largest_weight_sum = std::max(point.largest_weight_sum, point.weight_sum);
  double* sums = value_sums_.data() + q * width_;
  const double* value = values_.data() + p * width_;
  for (std::size_t c = 0; c < width_; ++c) sums[c] += signed_weight * value[c];
  if (++point.updates == kFreshAfter || point.weight_sum < 0.5 * point.largest_weight_sum) sum_afresh(q);
  update_mean(q);
}

double EstimationSums::pair_change(std::size_t q, std::uint32_t p, double weight) const {
  const Point& point = points_[q];
  const std::size_t first = q * width_;
  const double* value = &values_[p * width_];
  if (retained_[p]) {
    // The last one leaves the estimate 0.
    if (point.retained_count == 1)
      return squared_norm(&references_[first], width_) - squared_norm(&deviations_[first], width_);
    return change(&means_[first], &deviations_[first], value, width_, weight / (point.weight_sum - weight));
  }
  // The first one takes the estimate from 0 to its value, whatever its weight.
  const double a = point.retained_count == 0 ? -1.0 : -weight / (point.weight_sum + weight);
  return change(&means_[first], &deviations_[first], value, width_, a);
}

double EstimationSums::swapped_pair_change(std::size_t q, std::uint32_t out, double weight_out, std::uint32_t in,
                                           double weight_in) const {
  const Point& point = points_[q];
  const bool alone = point.retained_count == 1;
  const double weights = alone ? weight_in : point.weight_sum - weight_out + weight_in;
  double before = 0, after = 0;
  for (std::size_t c = 0; c < width_; ++c) {
    const std::size_t i = q * width_ + c;
    const double sum =
        (alone ? 0.0 : value_sums_[i] - weight_out * values_[out * width_ + c]) + weight_in * values_[in * width_ + c];
    const double deviation = sum / weights - references_[i];
    after += deviation * deviation;
    before += deviations_[i] * deviations_[i];
  }
  return after - before;
}

void EstimationSums::refresh_row(std::size_t q) {
  const Point& point = points_[q];
  const auto row = [&](std::uint64_t begin, std::uint32_t size) {
    return Row{&means_[q * width_],       &deviations_[q * width_], point.weight_sum,    size,
               &pair_observation_[begin], &pair_weight_[begin],     &pair_change_[begin]};
  };
  if (track_ == Track::retained || track_ == Track::both) {
    if (point.retained_count > 1)
      refresh_retained(row(point.row_begin, point.retained_count), values_.data(), increments_.data(), width_);
    else
      refresh_pairs_one_by_one(q, 0, point.retained_count);
  }
  if (track_ == Track::given_up || track_ == Track::both) {
    const std::uint32_t count = point.row_size - point.retained_count;
    if (point.retained_count > 0 && count > 0)
      refresh_given_up(row(point.row_begin + point.retained_count, count), values_.data(), increments_.data(), width_);
    else
      refresh_pairs_one_by_one(q, point.retained_count, point.row_size);
  }
}

// Where the sums are of one observation or none, and the formulas of the loops above divide by 0.
void EstimationSums::refresh_pairs_one_by_one(std::size_t q, std::uint32_t begin, std::uint32_t end) {
  for (std::uint64_t i = points_[q].row_begin + begin; i < points_[q].row_begin + end; ++i) {
    const std::uint32_t p = pair_observation_[i];
    const double now = pair_change(q, p, pair_weight_[i]);
    increments_[p] += now - pair_change_[i];
    pair_change_[i] = now;
  }
}

void EstimationSums::mark_row(std::size_t q, std::vector<std::uint32_t>& changed) {
  const Point& point = points_[q];
  const std::uint64_t begin = point.row_begin + (track_ == Track::given_up ? point.retained_count : 0);
  const std::uint64_t end = point.row_begin + (track_ == Track::retained ? point.retained_count : point.row_size);
  for (std::uint64_t i = begin; i < end; ++i) {
    const std::uint32_t p = pair_observation_[i];
    if (marked_at_[p] == step_) continue;
    marked_at_[p] = step_;
    changed.push_back(p);
  }
}

void EstimationSums::track(Track which) {
  track_ = which;
  if (which == Track::nothing) return;
  pair_change_.assign(pair_observation_.size(), 0.0);
  std::fill(increments_.begin(), increments_.end(), 0.0);
  for (std::size_t q = 0; q < points_.size(); ++q) refresh_row(q);
}

void EstimationSums::change_state(std::uint32_t p, std::vector<std::uint32_t>* changed) {
  // A copy: where the table is symmetric, the column is a row, and its pairs are about to move.
  const auto [points, weights] = column(p);
  const std::size_t count = column_size(p);
  reached_.assign(points, points + count);
  reached_weight_.assign(weights, weights + count);

  retained_[p] = !retained_[p];
  retained_count_ += retained_[p] ? 1 : -1;
  increments_[p] = 0;
  ++step_;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t q = reached_[i];
    update_point(q, p, reached_weight_[i]);
    if (track_ == Track::nothing) continue;
    refresh_row(q);
    if (changed) mark_row(q, *changed);
  }
}

double EstimationSums::increment(std::uint32_t p) const {
  const auto [points, weights] = column(p);
  double sum = 0;
  for (std::size_t i = 0; i < column_size(p); ++i) sum += pair_change(points[i], p, weights[i]);
  return sum;
}

double EstimationSums::swap_increment(std::uint32_t out, std::uint32_t in) {
  weight_out_.resize(points_.size(), 0.0);
  const auto [points_out, weights_out] = column(out);
  const auto [points_in, weights_in] = column(in);
  const std::size_t count_out = column_size(out), count_in = column_size(in);
  for (std::size_t i = 0; i < count_out; ++i) weight_out_[points_out[i]] = weights_out[i];
  double sum = 0;
  for (std::size_t i = 0; i < count_in; ++i) {
    double& weight_out = weight_out_[points_in[i]];
    sum += weight_out > 0 ? swapped_pair_change(points_in[i], out, weight_out, in, weights_in[i])
                          : pair_change(points_in[i], in, weights_in[i]);
    weight_out = 0;
  }
  for (std::size_t i = 0; i < count_out; ++i) {
    if (weight_out_[points_out[i]] > 0) sum += pair_change(points_out[i], out, weights_out[i]);
    weight_out_[points_out[i]] = 0;
  }
  return sum;
}

bool EstimationSums::changed_since(std::uint32_t p, std::uint32_t step) const {
  const std::uint32_t* points = column(p).first;
  for (std::size_t i = 0; i < column_size(p); ++i)
    if (points_[points[i]].changed_at > step) return true;
  return false;
}

std::vector<std::uint32_t> EstimationSums::retained() const {
  std::vector<std::uint32_t> result;
  result.reserve(retained_count_);
  for (std::uint32_t p = 0; p < retained_.size(); ++p)
    if (retained_[p]) result.push_back(p);
  return result;
}

std::uint32_t EstimationSums::observation_near(std::uint32_t p, double which_point, double which_pair) const {
  const std::uint32_t q = column(p).first[static_cast<std::size_t>(which_point * static_cast<double>(column_size(p)))];
  const Point& point = points_[q];
  return pair_observation_[point.row_begin + static_cast<std::uint64_t>(which_pair * point.row_size)];
}

double EstimationSums::error_sum() const {
  double sum = 0;
  for (std::size_t q = 0; q < points_.size(); ++q) sum += squared_norm(&deviations_[q * width_], width_);
  return sum;
}

}  // namespace thin
