#include "libthin/estimation/estimation_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "libthin/estimation/lanes.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

constexpr std::uint32_t kFreshAfter = 256;

// Beyond this, a in the multiplied-out change costs more digits than can be spared.
constexpr double kLargestFactor = 32;

constexpr std::size_t kRowsAhead = 4;
constexpr std::size_t kCacheLineBytes = 64;

constexpr std::uint32_t kNobody = 0xffffffff;

inline __attribute__((always_inline)) double dot(const double* x, const double* y, std::size_t width) {
  Lanes sum{};
  for (std::size_t c = 0; c < width; c += kLaneCount) sum += load(x + c) * load(y + c);
  return across(sum);
}

THIN_VECTOR_CLONES double dot_product(const double* x, const double* y, std::size_t width) {
  return dot(x, y, width);
}

inline __attribute__((always_inline)) void add_multiple(double* sums, const double* value, double weight,
                                                        std::size_t width) {
  for (std::size_t c = 0; c < width; c += kLaneCount) store(load(sums + c) + load(value + c) * weight, sums + c);
}

// What of a point follows from its sums.
inline __attribute__((always_inline)) void complete(PointSums& point, const double* sums, const double* reference,
                                                    std::size_t width) {
  point.one_over_weight_sum = point.retained_count > 0 ? 1 / point.weight_sum : 0;
  point.mean_squared = dot(sums, sums, width) * point.one_over_weight_sum * point.one_over_weight_sum;
  point.mean_by_deviation = point.mean_squared - dot(sums, reference, width) * point.one_over_weight_sum;
}

THIN_VECTOR_CLONES void complete_point(PointSums& point, const double* sums, const double* reference,
                                       std::size_t width) {
  complete(point, sums, reference, width);
}

// Sums of the retained among some pairs; returns Z.
THIN_VECTOR_CLONES double sum_pairs(const std::uint32_t* observation, const double* weight, std::uint32_t count,
                                    const std::uint8_t* retained, const double* values, std::size_t width,
                                    double* sums) {
  double weight_sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!retained[observation[i]]) continue;
    weight_sum += weight[i];
    add_multiple(sums, values + observation[i] * width, weight[i], width);
  }
  return weight_sum;
}

// The points and weights of a column, for the loops over it.
struct Reach {
  const std::uint32_t* points;
  const double* weights;
  std::size_t size;
};
using AtPlace = std::function<void(std::size_t)>;

// Brings the points that an observation reaches up to date with its change of state. afresh(i): sums the i-th anew.
THIN_VECTOR_CLONES void update_reached(const Reach& reach, PointSums* points, double* value_sums,
                                       const double* references, const double* value, std::size_t width, bool retained,
                                       std::uint32_t step, const AtPlace& afresh) {
  for (std::size_t i = 0; i < reach.size; ++i) {
    const std::uint32_t q = reach.points[i];
    PointSums& point = points[q];
    const double weight = retained ? reach.weights[i] : -reach.weights[i];
    point.retained_count += retained ? 1 : -1;
    point.changed_at = step;
    point.weight_sum += weight;
    point.largest_weight_sum = std::max(point.largest_weight_sum, point.weight_sum);
    if (++point.updates == kFreshAfter || point.weight_sum < 0.5 * point.largest_weight_sum)
      afresh(i);
    else
      add_multiple(value_sums + q * width, value, weight, width);
    complete(point, value_sums + q * width, references + q * width, width);
  }
}

// What an observation changing its state would change at each point that it reaches. careful(i): the i-th, where the
// multiplied-out form won't do.
THIN_VECTOR_CLONES void changes_of_reached(const Reach& reach, const PointSums* points, const double* value_sums,
                                           const double* references, const double* value, double square,
                                           std::size_t width, bool retained, double* changes, const AtPlace& careful) {
  for (std::size_t i = 0; i < reach.size; ++i) {
    const std::uint32_t q = reach.points[i];
    const PointSums& point = points[q];
    const double weight = reach.weights[i];
    const double a = retained ? weight / (point.weight_sum - weight) : -weight / (point.weight_sum + weight);
    if (retained && (point.retained_count < 2 || !(a <= kLargestFactor))) {
      careful(i);
      continue;
    }
    const double mean_by_value = dot(value_sums + q * width, value, width) * point.one_over_weight_sum;
    const double along = point.mean_by_deviation - mean_by_value + dot(references + q * width, value, width);
    const double distance = point.mean_squared - 2 * mean_by_value + square;
    changes[i] = a * (2 * along + a * distance);
  }
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
  const double* deviation;
  double weight_sum;
  double one_over_weight_sum;
  double mean_squared;
  double mean_by_deviation;
  std::uint32_t size;
  const std::uint32_t* observation;
  const double* weight;
  double* change;  // cached
};

struct Observations {
  const double* values;
  const double* squares;
  double* increments;
  std::size_t width;
};

// The change that each of four pairs would cause, multiplied out; `factor` becomes their a.
template <std::size_t Width, bool Retained>
inline __attribute__((always_inline)) Lanes changes(const Row& row, const std::uint32_t* observation,
                                                    const double* weights, const Observations& all, Lanes& factor) {
  const std::size_t width = Width ? Width : all.width;
  Lanes products[kLaneCount] = {}, deviating[kLaneCount] = {};
  Lanes square;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    const double* value = all.values + observation[lane] * width;
    for (std::size_t c = 0; c < width; c += kLaneCount) {
      products[lane] += load(row.value_sum + c) * load(value + c);
      deviating[lane] += load(row.deviation + c) * load(value + c);
    }
    square[lane] = all.squares[observation[lane]];
  }
  const Lanes mean_by_value = across_each(products[0], products[1], products[2], products[3]) * row.one_over_weight_sum;
  const Lanes weight = load(weights);
  factor = Retained ? weight / (row.weight_sum - weight) : -weight / (row.weight_sum + weight);
  const Lanes along = row.mean_by_deviation - across_each(deviating[0], deviating[1], deviating[2], deviating[3]);
  const Lanes distance = row.mean_squared - 2 * mean_by_value + square;
  return factor * (2 * along + factor * distance);
}

inline __attribute__((always_inline)) bool any_beyond(const Lanes& factor) {
  return !(factor[0] <= kLargestFactor && factor[1] <= kLargestFactor && factor[2] <= kLargestFactor &&
           factor[3] <= kLargestFactor);
}

// The inner loop of full updating: makes the changes of the row's pairs right, and moves the increments by what they
// differ from the cached ones. Whose change fell is written to `fallen`, with room for all; returns how many these are.
// careful(i): the change of the i-th pair, where the multiplied-out form won't do.
template <std::size_t Width, bool Retained, class Careful>
inline __attribute__((always_inline)) std::size_t refresh(const Row& row, const Observations& all,
                                                          const Careful& careful, std::uint32_t* fallen) {
  std::size_t fallen_count = 0;
  // The pairs from i on: `count` of them count, the arrays hold four.
  const auto take = [&](std::uint32_t i, std::uint32_t count, const std::uint32_t* observation, const double* weight,
                        double* cached) __attribute__((always_inline)) {
    Lanes factor;
    Lanes now = changes<Width, Retained>(row, observation, weight, all, factor);
    if (Retained && any_beyond(factor))
      for (std::uint32_t lane = 0; lane < count; ++lane)
        if (!(factor[lane] <= kLargestFactor)) now[lane] = careful(i + lane);
    const Lanes difference = now - load(cached);
    store(now, cached);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      all.increments[observation[lane]] += difference[lane];
      fallen[fallen_count] = observation[lane];
      fallen_count += difference[lane] < 0;
    }
  };
  std::uint32_t i = 0;
  for (; i + kLaneCount <= row.size; i += kLaneCount)
    take(i, kLaneCount, row.observation + i, row.weight + i, row.change + i);
  if (i == row.size) return fallen_count;
  std::uint32_t observation[kLaneCount];
  double weight[kLaneCount], cached[kLaneCount];
  for (std::uint32_t lane = 0; lane < kLaneCount; ++lane) {
    const std::uint32_t pair = std::min(i + lane, row.size - 1);
    observation[lane] = row.observation[pair];
    weight[lane] = row.weight[pair];
    cached[lane] = row.change[pair];
  }
  take(i, row.size - i, observation, weight, cached);
  for (std::uint32_t lane = 0; i + lane < row.size; ++lane) row.change[i + lane] = cached[lane];
  return fallen_count;
}

template <bool Retained, class Careful>
inline __attribute__((always_inline)) std::size_t refresh(const Row& row, const Observations& all,
                                                          const Careful& careful, std::uint32_t* fallen) {
  switch (all.width) {
    case 4:
      return refresh<4, Retained>(row, all, careful, fallen);
    case 8:
      return refresh<8, Retained>(row, all, careful, fallen);
    case 12:
      return refresh<12, Retained>(row, all, careful, fallen);
    case 16:
      return refresh<16, Retained>(row, all, careful, fallen);
    default:
      return refresh<0, Retained>(row, all, careful, fallen);
  }
}

using CarefulChange = std::function<double(std::uint32_t)>;

THIN_VECTOR_CLONES std::size_t refresh_retained(const Row& row, const Observations& all, const CarefulChange& careful,
                                                std::uint32_t* fallen) {
  return refresh<true>(row, all, careful, fallen);
}
THIN_VECTOR_CLONES std::size_t refresh_given_up(const Row& row, const Observations& all, const CarefulChange& careful,
                                                std::uint32_t* fallen) {
  return refresh<false>(row, all, careful, fallen);
}

// Where p stands among these. Without a way out, so that it is a few vector comparisons. REQUIRES: once
THIN_VECTOR_CLONES std::uint32_t place_of(std::uint32_t p, const std::uint32_t* observation, std::uint32_t count) {
  std::uint32_t place = 0;
  for (std::uint32_t i = 0; i < count; ++i) place |= observation[i] == p ? i : 0;
  return place;
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
    squares_[p] = dot_product(values_.data() + p * width_, values_.data() + p * width_, width_);
  assign_in_large_pages(points_, points);
  assign_in_large_pages(value_sums_, points * width_);
  assign_in_large_pages(references_, points * width_);
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
      complete_point(points_[q], &value_sums_[q * width_], &references_[q * width_], width_);
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

void EstimationSums::sum_afresh(std::size_t q) {
  PointSums& point = points_[q];
  double* sums = value_sums_.data() + q * width_;
  std::fill(sums, sums + width_, 0.0);
  point.weight_sum = sum_pairs(&pair_observation_[point.row_begin], &pair_weight_[point.row_begin], point.row_size,
                               retained_.data(), values_.data(), width_, sums);
  point.largest_weight_sum = point.weight_sum;
  point.updates = 0;
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

// Across the border between the retained and the others. REQUIRES: p's state and the point's count have changed, and
// otherwise the rows are parted
void EstimationSums::move_pair(std::size_t q, std::uint32_t p) {
  const PointSums& point = points_[q];
  const bool to_front = retained_[p];
  // The place that the border has moved over: the last of the front now, or the first behind it.
  const std::uint64_t border = point.row_begin + point.retained_count - (to_front ? 1 : 0);
  const std::uint64_t begin = to_front ? border : point.row_begin;
  const std::uint64_t end = to_front ? point.row_begin + point.row_size : border + 1;
  const std::uint64_t place = begin + place_of(p, &pair_observation_[begin], static_cast<std::uint32_t>(end - begin));
  std::swap(pair_observation_[place], pair_observation_[border]);
  std::swap(pair_weight_[place], pair_weight_[border]);
  std::swap(pair_change_[place], pair_change_[border]);
  pair_change_[border] = 0;
}

// The error at q with `out` given up and `in` retained (either may be kNobody), less the error now.
double EstimationSums::change_to(std::size_t q, double weight_sum, std::uint32_t out, double weight_out,
                                 std::uint32_t in, double weight_in) const {
  const PointSums& point = points_[q];
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
  const PointSums& point = points_[q];
  if (!retained_[p]) return change_to(q, point.weight_sum + weight, kNobody, 0, p, weight);
  return change_to(q, point.retained_count > 1 ? point.weight_sum - weight : 0, p, weight, kNobody, 0);
}

void EstimationSums::column_changes(std::uint32_t p, const Column& near, std::vector<double>& result) const {
  if (result.size() < near.size) result.resize(near.size);
  const auto careful = [&](std::size_t i) { result[i] = careful_pair_change(near.points[i], p, near.weights[i]); };
  changes_of_reached({near.points, near.weights, near.size}, points_.data(), value_sums_.data(), references_.data(),
                     values_.data() + p * width_, squares_[p], width_, retained_[p], result.data(), std::cref(careful));
}

void EstimationSums::refresh_pairs(std::size_t q, std::uint32_t begin, std::uint32_t end, bool retained,
                                   double* changes) {
  if (begin == end) return;
  const PointSums& point = points_[q];
  const std::uint64_t first = point.row_begin + begin;
  const std::uint32_t size = end - begin;
  if (fallen_.size() < fallen_count_ + size) fallen_.resize(2 * (fallen_count_ + size));
  for (std::size_t c = 0; c < width_; ++c)
    deviation_[c] = value_sums_[q * width_ + c] * point.one_over_weight_sum - references_[q * width_ + c];
  const Row row{value_sums_.data() + q * width_, deviation_.data(),
                // With one left, taking it out leaves none: not a number leads to careful_pair_change.
                retained && point.retained_count < 2 ? std::numeric_limits<double>::quiet_NaN() : point.weight_sum,
                point.one_over_weight_sum, point.mean_squared, point.mean_by_deviation, size, &pair_observation_[first],
                &pair_weight_[first], changes};
  const Observations all{values_.data(), squares_.data(), increments_.data(), width_};
  const auto careful = [&](std::uint32_t i) { return careful_pair_change(q, row.observation[i], row.weight[i]); };
  // Called by name each: through a pointer the clones would not be chosen from.
  std::uint32_t* fallen = fallen_.data() + fallen_count_;
  fallen_count_ += retained ? refresh_retained(row, all, std::cref(careful), fallen)
                            : refresh_given_up(row, all, std::cref(careful), fallen);
}

void EstimationSums::refresh_row(std::size_t q) {
  const PointSums& point = points_[q];
  const std::uint64_t border = point.row_begin + point.retained_count;
  if (track_ != Track::given_up) refresh_pairs(q, 0, point.retained_count, true, &pair_change_[point.row_begin]);
  if (track_ != Track::retained)
    refresh_pairs(q, point.retained_count, point.row_size, false, pair_change_.data() + border);
}

void EstimationSums::track(Track which) {
  track_ = which;
  if (which == Track::nothing) return;
  part_rows();
  assign_in_large_pages(pair_change_, pair_observation_.size());
  deviation_.resize(width_);
  std::fill(increments_.begin(), increments_.end(), 0.0);
  for (std::size_t q = 0; q < points_.size(); ++q) {
    fallen_count_ = 0;
    refresh_row(q);
  }
}

// Asks for the memory of a row, which lies far from the one before.
void EstimationSums::fetch(std::size_t q) const {
  const auto lines = [](const auto* from, std::size_t count) {
    const auto* bytes = reinterpret_cast<const char*>(from);
    for (std::size_t i = 0; i < count * sizeof(*from); i += kCacheLineBytes) __builtin_prefetch(bytes + i);
  };
  const PointSums& point = points_[q];
  const std::uint64_t begin = point.row_begin + (track_ == Track::given_up ? point.retained_count : 0);
  const std::size_t size = track_ == Track::retained ? point.retained_count : point.row_begin + point.row_size - begin;
  lines(pair_observation_.data() + begin, size);
  lines(pair_weight_.data() + begin, size);
  lines(pair_change_.data() + begin, size);
}

void EstimationSums::compute_increments() {
  std::fill(increments_.begin(), increments_.end(), 0.0);
  deviation_.resize(width_);
  for (std::size_t q = 0; q < points_.size(); ++q) {
    changes_.assign(points_[q].row_size, 0.0);
    fallen_count_ = 0;
    refresh_pairs(q, 0, points_[q].row_size, points_[q].retained_count > 0, changes_.data());
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
  const auto afresh = [&](std::size_t i) { sum_afresh(reached_[i]); };
  update_reached({reached_.data(), reached_weight_.data(), reached_.size()}, points_.data(), value_sums_.data(),
                 references_.data(), values_.data() + p * width_, width_, retained, step_, std::cref(afresh));
  if (track_ == Track::nothing) return;
  for (std::size_t i = 0; i < reached_.size(); ++i) {
    if (i + kRowsAhead < reached_.size()) fetch(reached_[i + kRowsAhead]);
    move_pair(reached_[i], p);
    refresh_row(reached_[i]);
  }
}

double EstimationSums::increment(std::uint32_t p) const {
  const Column near = column(p);
  column_changes(p, near, changes_);
  double sum = 0;
  for (std::size_t i = 0; i < near.size; ++i) sum += changes_[i];
  return sum;
}

double EstimationSums::swap_increment(std::uint32_t out, std::uint32_t in) {
  weight_out_.resize(points_.size(), 0.0);
  const Column near_out = column(out), near_in = column(in);
  column_changes(out, near_out, changes_out_);
  column_changes(in, near_in, changes_);
  for (std::size_t i = 0; i < near_out.size; ++i) weight_out_[near_out.points[i]] = near_out.weights[i];
  double sum = 0;
  for (std::size_t i = 0; i < near_in.size; ++i) {
    const std::uint32_t q = near_in.points[i];
    const double weight_in = near_in.weights[i], weight_out = weight_out_[q];
    weight_out_[q] = 0;
    sum += weight_out > 0
               ? change_to(q, (points_[q].retained_count > 1 ? points_[q].weight_sum - weight_out : 0) + weight_in, out,
                           weight_out, in, weight_in)
               : changes_[i];
  }
  for (std::size_t i = 0; i < near_out.size; ++i) {
    double& weight_out = weight_out_[near_out.points[i]];
    if (weight_out > 0) sum += changes_out_[i];
    weight_out = 0;
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
  const PointSums& point = points_[near.points[static_cast<std::size_t>(which_point * static_cast<double>(near.size))]];
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
