#include "libthin/estimation/estimation_sums.h"

#include <algorithm>
#include <cmath>

#include "libthin/estimation/lanes.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

constexpr std::uint32_t kFreshAfter = 256;

// Beyond this, a in the multiplied-out change costs more digits than can be spared.
constexpr double kLargestFactor = 32;

constexpr std::uint32_t kNobody = 0xffffffff;

inline __attribute__((always_inline)) double dot(const double* x, const double* y, std::size_t width) {
  Lanes sum{};
  for (std::size_t c = 0; c < width; c += kLaneCount) sum += load(x + c) * load(y + c);
  return across(sum);
}

THIN_VECTOR_CLONES double dot_product(const double* x, const double* y, std::size_t width) {
  return dot(x, y, width);
}

THIN_VECTOR_CLONES void add_multiple(double* sums, const double* value, double weight, std::size_t width) {
  for (std::size_t c = 0; c < width; c += kLaneCount) store(load(sums + c) + load(value + c) * weight, sums + c);
}

// across() of four at once, to the same bits.
inline __attribute__((always_inline)) Lanes across_each(const Lanes& a, const Lanes& b, const Lanes& c,
                                                        const Lanes& d) {
  using Places = std::int64_t __attribute__((vector_size(sizeof(Lanes))));
  const Lanes ab = __builtin_shuffle(a, b, Places{0, 4, 2, 6}) + __builtin_shuffle(a, b, Places{1, 5, 3, 7});
  const Lanes cd = __builtin_shuffle(c, d, Places{0, 4, 2, 6}) + __builtin_shuffle(c, d, Places{1, 5, 3, 7});
  return __builtin_shuffle(ab, cd, Places{0, 1, 4, 5}) + __builtin_shuffle(ab, cd, Places{2, 3, 6, 7});
}

struct Row {
  const double* value_sum;
  double weight_sum;
  double one_over_weight_sum;
  double mean_squared;
  double mean_by_deviation;
  std::uint32_t size;
  const std::uint32_t* observation;
  const double* weight;
  const double* cross;
};

// The inner loop of full updating, for `Lanes` pairs from i on: the change that each would cause, and its factor a.
template <std::size_t Width, bool Retained>
inline __attribute__((always_inline)) Lanes changes(const Row& row, const std::uint32_t* observation,
                                                    const double* weights, const double* crosses, const double* values,
                                                    const double* squares, std::size_t any_width, Lanes& factor) {
  const std::size_t width = Width ? Width : any_width;
  Lanes products[kLaneCount] = {};
  Lanes square;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    const double* value = values + observation[lane] * width;
    for (std::size_t c = 0; c < width; c += kLaneCount) products[lane] += load(row.value_sum + c) * load(value + c);
    square[lane] = squares[observation[lane]];
  }
  const Lanes mean_by_value = across_each(products[0], products[1], products[2], products[3]) * row.one_over_weight_sum;
  const Lanes weight = load(weights);
  factor = Retained ? weight / (row.weight_sum - weight) : -weight / (row.weight_sum + weight);
  const Lanes along = row.mean_by_deviation - mean_by_value + load(crosses);
  const Lanes distance = row.mean_squared - 2 * mean_by_value + square;
  return factor * (2 * along + factor * distance);
}

// Of all pairs of the row, into `result` and `factors` (with room for whole groups of lanes).
template <std::size_t Width, bool Retained>
inline __attribute__((always_inline)) void row_changes(const Row& row, const double* values, const double* squares,
                                                       std::size_t width, double* result, double* factors) {
  Lanes factor;
  std::uint32_t i = 0;
  for (; i + kLaneCount <= row.size; i += kLaneCount) {
    store(changes<Width, Retained>(row, row.observation + i, row.weight + i, row.cross + i, values, squares, width,
                                   factor),
          result + i);
    store(factor, factors + i);
  }
  if (i == row.size) return;
  std::uint32_t observation[kLaneCount];
  double weight[kLaneCount], cross[kLaneCount];
  for (std::uint32_t lane = 0; lane < kLaneCount; ++lane) {
    const std::uint32_t pair = std::min(i + lane, row.size - 1);
    observation[lane] = row.observation[pair];
    weight[lane] = row.weight[pair];
    cross[lane] = row.cross[pair];
  }
  store(changes<Width, Retained>(row, observation, weight, cross, values, squares, width, factor), result + i);
  store(factor, factors + i);
}

template <bool Retained>
inline __attribute__((always_inline)) void row_changes(const Row& row, const double* values, const double* squares,
                                                       std::size_t width, double* result, double* factors) {
  switch (width) {
    case 4:
      return row_changes<4, Retained>(row, values, squares, width, result, factors);
    case 8:
      return row_changes<8, Retained>(row, values, squares, width, result, factors);
    case 12:
      return row_changes<12, Retained>(row, values, squares, width, result, factors);
    case 16:
      return row_changes<16, Retained>(row, values, squares, width, result, factors);
    default:
      return row_changes<0, Retained>(row, values, squares, width, result, factors);
  }
}

THIN_VECTOR_CLONES void changes_of_retained(const Row& row, const double* values, const double* squares,
                                            std::size_t width, double* result, double* factors) {
  row_changes<true>(row, values, squares, width, result, factors);
}
THIN_VECTOR_CLONES void changes_of_given_up(const Row& row, const double* values, const double* squares,
                                            std::size_t width, double* result, double* factors) {
  row_changes<false>(row, values, squares, width, result, factors);
}

// Moves the increments by what the changes differ from the cached ones, which they replace. Whose change fell is
// appended to `fallen`; returns how many these are.
std::size_t move_increments(const std::uint32_t* observation, const double* now, std::uint32_t count, double* cached,
                            double* increments, std::uint32_t* fallen) {
  std::size_t fallen_count = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double difference = now[i] - cached[i];
    increments[observation[i]] += difference;
    cached[i] = now[i];
    fallen[fallen_count] = observation[i];
    fallen_count += difference < 0;
  }
  return fallen_count;
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
      retained_count_(table.observations) {
  const std::size_t points = table.row_begin.size() - 1;
  squares_.resize(table.observations);
  for (std::size_t p = 0; p < table.observations; ++p)
    squares_[p] = product(values_.data() + p * width_, values_.data() + p * width_);
  points_.resize(points);
  value_sums_.resize(points * width_);
  references_.assign(points * width_, 0.0);
  for (std::size_t q = 0; q < points; ++q) {
    const auto size = static_cast<std::uint32_t>(table.row_begin[q + 1] - table.row_begin[q]);
    points_[q] = {table.row_begin[q], size, size, 0, 0, 0, 0, 0, 0, 0};
  }
  parallel_ranges(points, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      sum_afresh(q);
      for (std::size_t c = 0; c < width_; ++c)
        references_[q * width_ + c] = points_[q].row_size ? value_sums_[q * width_ + c] / points_[q].weight_sum : 0.0;
      if (start == Start::with_none) {
        points_[q].retained_count = 0;
        points_[q].weight_sum = points_[q].largest_weight_sum = 0;
        std::fill_n(value_sums_.begin() + static_cast<std::ptrdiff_t>(q * width_), width_, 0.0);
      }
      update_point(q);
    }
  });
  if (start == Start::with_all) return;
  std::fill(retained_.begin(), retained_.end(), std::uint8_t{0});
  retained_count_ = 0;
}

EstimationSums::Column EstimationSums::column(std::uint32_t p) const {
  if (column_begin_.empty())
    return {&pair_observation_[points_[p].row_begin], &pair_weight_[points_[p].row_begin], points_[p].row_size};
  return {column_point_.data() + column_begin_[p], column_weight_.data() + column_begin_[p],
          column_begin_[p + 1] - column_begin_[p]};
}

double EstimationSums::product(const double* a, const double* b) const {
  return dot_product(a, b, width_);
}

void EstimationSums::sum_afresh(std::size_t q) {
  Point& point = points_[q];
  double* sums = value_sums_.data() + q * width_;
  std::fill(sums, sums + width_, 0.0);
  point.weight_sum = 0;
  for (std::uint64_t i = point.row_begin; i < point.row_begin + point.row_size; ++i) {
    const std::uint32_t p = pair_observation_[i];
    if (!retained_[p]) continue;
    point.weight_sum += pair_weight_[i];
    add_multiple(sums, values_.data() + p * width_, pair_weight_[i], width_);
  }
  point.largest_weight_sum = point.weight_sum;
  point.updates = 0;
}

// What of a point follows from its sums.
void EstimationSums::update_point(std::size_t q) {
  Point& point = points_[q];
  const double* sums = value_sums_.data() + q * width_;
  point.one_over_weight_sum = point.retained_count > 0 ? 1 / point.weight_sum : 0;
  point.mean_squared = product(sums, sums) * point.one_over_weight_sum * point.one_over_weight_sum;
  point.mean_by_deviation =
      point.mean_squared - product(sums, references_.data() + q * width_) * point.one_over_weight_sum;
}

// Brings the retained of every row to its front.
void EstimationSums::part_rows() {
  parallel_ranges(points_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      std::uint64_t border = points_[q].row_begin;
      for (std::uint64_t i = border; i < points_[q].row_begin + points_[q].row_size; ++i) {
        if (!retained_[pair_observation_[i]]) continue;
        std::swap(pair_observation_[i], pair_observation_[border]);
        std::swap(pair_weight_[i], pair_weight_[border]);
        ++border;
      }
    }
  });
}

// Across the border between the retained and the others. REQUIRES: parted rows; p's state has changed, the point's
// count has not
void EstimationSums::move_pair(std::size_t q, std::uint32_t p) {
  const Point& point = points_[q];
  const bool to_front = retained_[p];
  const auto row = pair_observation_.begin() + static_cast<std::ptrdiff_t>(point.row_begin);
  const auto place = point.row_begin +
                     static_cast<std::uint64_t>(std::find(row + (to_front ? point.retained_count : 0),
                                                          row + (to_front ? point.row_size : point.retained_count), p) -
                                                row);
  const std::uint64_t border = point.row_begin + (to_front ? point.retained_count : point.retained_count - 1);
  std::swap(pair_observation_[place], pair_observation_[border]);
  std::swap(pair_weight_[place], pair_weight_[border]);
  std::swap(pair_cross_[place], pair_cross_[border]);
  std::swap(pair_change_[place], pair_change_[border]);
  pair_change_[border] = 0;
}

// The error at q with `out` given up and `in` retained (either may be kNobody), less the error now.
double EstimationSums::change_to(std::size_t q, double weight_sum, std::uint32_t out, double weight_out,
                                 std::uint32_t in, double weight_in) const {
  const Point& point = points_[q];
  double before = 0, after = 0;
  for (std::size_t c = 0; c < width_; ++c) {
    double sum = value_sums_[q * width_ + c];
    const double reference = references_[q * width_ + c];
    const double deviation = sum * point.one_over_weight_sum - reference;
    before += deviation * deviation;
    if (out != kNobody) sum = point.retained_count > 1 ? sum - weight_out * values_[out * width_ + c] : 0;
    if (in != kNobody) sum += weight_in * values_[in * width_ + c];
    const double deviation_after = weight_sum > 0 ? sum / weight_sum - reference : -reference;
    after += deviation_after * deviation_after;
  }
  return after - before;
}

double EstimationSums::careful_pair_change(std::size_t q, std::uint32_t p, double weight) const {
  const Point& point = points_[q];
  if (!retained_[p]) return change_to(q, point.weight_sum + weight, kNobody, 0, p, weight);
  return change_to(q, point.retained_count > 1 ? point.weight_sum - weight : 0, p, weight, kNobody, 0);
}

double EstimationSums::pair_change(std::size_t q, std::uint32_t p, double weight) const {
  const Point& point = points_[q];
  const double* value = values_.data() + p * width_;
  const double factor = retained_[p] ? weight / (point.weight_sum - weight) : -weight / (point.weight_sum + weight);
  if ((retained_[p] && point.retained_count < 2) || !(std::abs(factor) <= kLargestFactor))
    return careful_pair_change(q, p, weight);
  const double mean_by_value = product(value_sums_.data() + q * width_, value) * point.one_over_weight_sum;
  const double along = point.mean_by_deviation - mean_by_value + product(references_.data() + q * width_, value);
  const double distance = point.mean_squared - 2 * mean_by_value + squares_[p];
  return factor * (2 * along + factor * distance);
}

void EstimationSums::refresh_pairs(std::size_t q, std::uint32_t begin, std::uint32_t end, bool retained) {
  const Point& point = points_[q];
  if (begin == end) return;
  const std::uint64_t first = point.row_begin + begin;
  const std::uint32_t size = end - begin;
  const Row row{value_sums_.data() + q * width_,
                point.weight_sum,
                point.one_over_weight_sum,
                point.mean_squared,
                point.mean_by_deviation,
                size,
                &pair_observation_[first],
                &pair_weight_[first],
                &pair_cross_[first]};
  if (changes_.size() < size + kLaneCount) {
    changes_.resize(2 * size + kLaneCount);
    factors_.resize(2 * size + kLaneCount);
  }
  (retained ? changes_of_retained : changes_of_given_up)(row, values_.data(), squares_.data(), width_, changes_.data(),
                                                         factors_.data());
  if (retained)
    for (std::uint32_t i = 0; i < size; ++i)
      if (point.retained_count < 2 || !(factors_[i] <= kLargestFactor))
        changes_[i] = careful_pair_change(q, row.observation[i], row.weight[i]);
  if (fallen_.size() < fallen_count_ + size) fallen_.resize(2 * (fallen_count_ + size));
  fallen_count_ += move_increments(row.observation, changes_.data(), size, &pair_change_[first], increments_.data(),
                                   fallen_.data() + fallen_count_);
}

void EstimationSums::refresh_row(std::size_t q) {
  const Point& point = points_[q];
  if (track_ != Track::given_up) refresh_pairs(q, 0, point.retained_count, true);
  if (track_ != Track::retained) refresh_pairs(q, point.retained_count, point.row_size, false);
}

void EstimationSums::track(Track which) {
  track_ = which;
  if (which == Track::nothing) return;
  part_rows();
  pair_change_.assign(pair_observation_.size(), 0.0);
  pair_cross_.resize(pair_observation_.size());
  parallel_ranges(points_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q)
      for (std::uint64_t i = points_[q].row_begin; i < points_[q].row_begin + points_[q].row_size; ++i)
        pair_cross_[i] = product(references_.data() + q * width_, values_.data() + pair_observation_[i] * width_);
  });
  std::fill(increments_.begin(), increments_.end(), 0.0);
  for (std::size_t q = 0; q < points_.size(); ++q) {
    fallen_count_ = 0;
    refresh_row(q);
  }
}

void EstimationSums::change_state(std::uint32_t p) {
  // A copy: where the table is symmetric, the column is a row, and its pairs are about to move.
  const Column near = column(p);
  reached_.assign(near.points, near.points + near.size);
  reached_weight_.assign(near.weights, near.weights + near.size);

  retained_[p] = !retained_[p];
  const bool retained = retained_[p];
  retained_count_ += retained ? 1 : -1;
  increments_[p] = 0;
  fallen_count_ = 0;
  ++step_;
  for (std::size_t i = 0; i < reached_.size(); ++i) {
    const std::uint32_t q = reached_[i];
    Point& point = points_[q];
    if (track_ != Track::nothing) move_pair(q, p);
    const double weight = retained ? reached_weight_[i] : -reached_weight_[i];
    point.retained_count += retained ? 1 : -1;
    point.changed_at = step_;
    point.weight_sum += weight;
    point.largest_weight_sum = std::max(point.largest_weight_sum, point.weight_sum);
    if (++point.updates == kFreshAfter || point.weight_sum < 0.5 * point.largest_weight_sum)
      sum_afresh(q);
    else
      add_multiple(value_sums_.data() + q * width_, values_.data() + p * width_, weight, width_);
    update_point(q);
    if (track_ != Track::nothing) refresh_row(q);
  }
}

double EstimationSums::increment(std::uint32_t p) const {
  const Column near = column(p);
  double sum = 0;
  for (std::size_t i = 0; i < near.size; ++i) sum += pair_change(near.points[i], p, near.weights[i]);
  return sum;
}

double EstimationSums::swap_increment(std::uint32_t out, std::uint32_t in) {
  weight_out_.resize(points_.size(), 0.0);
  const Column near_out = column(out), near_in = column(in);
  for (std::size_t i = 0; i < near_out.size; ++i) weight_out_[near_out.points[i]] = near_out.weights[i];
  double sum = 0;
  for (std::size_t i = 0; i < near_in.size; ++i) {
    const std::uint32_t q = near_in.points[i];
    const double weight_in = near_in.weights[i], weight_out = weight_out_[q];
    weight_out_[q] = 0;
    if (weight_out > 0)
      sum += change_to(q, (points_[q].retained_count > 1 ? points_[q].weight_sum - weight_out : 0) + weight_in, out,
                       weight_out, in, weight_in);
    else
      sum += pair_change(q, in, weight_in);
  }
  for (std::size_t i = 0; i < near_out.size; ++i) {
    const std::uint32_t q = near_out.points[i];
    if (weight_out_[q] > 0) sum += pair_change(q, out, near_out.weights[i]);
    weight_out_[q] = 0;
  }
  return sum;
}

bool EstimationSums::changed_since(std::uint32_t p, std::uint32_t step) const {
  const Column near = column(p);
  for (std::size_t i = 0; i < near.size; ++i)
    if (points_[near.points[i]].changed_at > step) return true;
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
  const Column near = column(p);
  const Point& point = points_[near.points[static_cast<std::size_t>(which_point * static_cast<double>(near.size))]];
  return pair_observation_[point.row_begin + static_cast<std::uint64_t>(which_pair * point.row_size)];
}

double EstimationSums::error_sum() const {
  double sum = 0;
  for (std::size_t q = 0; q < points_.size(); ++q)
    for (std::size_t c = 0; c < width_; ++c) {
      const double deviation =
          value_sums_[q * width_ + c] * points_[q].one_over_weight_sum - references_[q * width_ + c];
      sum += deviation * deviation;
    }
  return sum;
}

}  // namespace thin
