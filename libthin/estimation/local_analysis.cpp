#include "libthin/estimation/local_analysis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "libthin/estimation/analysis_target.h"
#include "libthin/estimation/lanes.h"
#include "libthin/estimation/neighbourhood_table.h"
#include "libthin/foundation/memory.h"

namespace thin {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// What keeps k on its side of 0 where the cut-off has bent a variance: variances within 0 .. (1 - kLeastMargin) r².
constexpr double kLeastMargin = 1e-3;

// Rows of one channel stand close together, others in whole groups of lanes.
std::size_t row_width(std::size_t channels) {
  return channels == 1 ? 1 : padded(channels);
}

// The observations reached so far; each once.
struct Touched {
  std::uint32_t* observations;  // room for one more than all
  std::size_t count;
};

// The pairs of one evaluation point, and what changes there.
struct Row {
  const std::uint32_t* observation;
  double* covariance;
  std::size_t size;
  double step;              // k times the column at the point
  const double* misfit;     // before
  const double* misfit_to;  // after
};

// What changes of the observations; n elements each, g n x width.
struct Moved {
  const double* column;  // of the observation that changes state; 0 beyond its reach
  std::uint32_t* at_step;
  double* g;
  double* s;
  std::uint32_t step;
};

inline __attribute__((always_inline)) void touch(std::uint32_t p, const Moved& all, Touched& touched) {
  touched.observations[touched.count] = p;
  touched.count += all.at_step[p] != all.step;
  all.at_step[p] = all.step;
}

template <std::size_t Width>
inline __attribute__((always_inline)) void move_g(std::uint32_t p, double before, double after, const Row& row,
                                                  const Moved& all, std::size_t row_width) {
  if constexpr (Width == 1) {
    all.g[p] += after * row.misfit_to[0] - before * row.misfit[0];
  } else {
    const std::size_t width = Width ? Width : row_width;
    double* g = all.g + p * width;
    for (std::size_t c = 0; c < width; c += kLaneCount)
      store(load(g + c) + (load(row.misfit_to + c) * after - load(row.misfit + c) * before), g + c);
  }
}

// Moves g and s of the row's observations from the old covariances and misfit to the new ones. Neighbours in place are
// mostly neighbours in order, as fields of view along a scan line are: four in a row are taken at once, to the same
// bits.
template <std::size_t Width>
inline __attribute__((always_inline)) void update_row(const Row& row, const Moved& all, std::size_t row_width,
                                                      Touched& touched) {
  for (std::size_t i = 0; i < row.size;) {
    const std::uint32_t p = row.observation[i];
    if (i + kLaneCount <= row.size && row.observation[i + kLaneCount - 1] == p + kLaneCount - 1) {
      const Lanes before = load(row.covariance + i);
      const Lanes after = before - row.step * load(all.column + p);
      store(after, row.covariance + i);
      store(load(all.s + p) + (after * after - before * before), all.s + p);
      if constexpr (Width == 1)
        store(load(all.g + p) + (after * row.misfit_to[0] - before * row.misfit[0]), all.g + p);
      else
        for (std::uint32_t lane = 0; lane < kLaneCount; ++lane)
          move_g<Width>(p + lane, before[lane], after[lane], row, all, row_width);
      for (std::uint32_t lane = 0; lane < kLaneCount; ++lane) touch(p + lane, all, touched);
      i += kLaneCount;
      continue;
    }
    const double before = row.covariance[i];
    const double after = before - row.step * all.column[p];
    row.covariance[i] = after;
    all.s[p] += after * after - before * before;
    move_g<Width>(p, before, after, row, all, row_width);
    touch(p, all, touched);
    ++i;
  }
}

THIN_VECTOR_CLONES void update_any_row(const Row& row, const Moved& all, std::size_t width, Touched& touched) {
  if (width == 1)
    update_row<1>(row, all, width, touched);
  else if (width == 4)
    update_row<4>(row, all, width, touched);
  else
    update_row<0>(row, all, width, touched);
}

// Subtracts a multiple of u from what is kept by observation.
THIN_VECTOR_CLONES void subtract_multiple(const std::uint32_t* observation, const double* u, std::size_t size,
                                          double factor, double* from) {
  for (std::size_t i = 0; i < size;) {
    const std::uint32_t p = observation[i];
    if (i + kLaneCount <= size && observation[i + kLaneCount - 1] == p + kLaneCount - 1) {
      store(load(from + p) - load(u + i) * factor, from + p);
      i += kLaneCount;
      continue;
    }
    from[p] -= u[i] * factor;
    ++i;
  }
}

}  // namespace

LocalAnalysis::LocalAnalysis(const Places& observations, std::span<const double> values, std::size_t channels,
                             std::vector<std::uint32_t> evaluation_points, std::span<const double> targets,
                             const AnalysisModel& model)
    : channels_(channels),
      width_(row_width(channels)),
      model_(model),
      places_(observations),
      tree_(observations.coordinates, observations.dimension),
      points_(std::move(evaluation_points)),
      point_at_(observations.size(), kNone),
      departures_(values.begin(), values.end()),
      variances_(observations.size(), 1.0),
      increments_(observations.size(), 0.0),
      retained_(observations.size(), 0),
      column_at_(observations.size(), 0.0),
      changed_at_(observations.size(), 0),
      work_(observations.size(), 0.0),
      touched_(observations.size() + 1),
      last_changed_(kNone) {
  NeighbourhoodTable table =
      std::move(*neighbourhood_rows(places_among(places_, points_), places_, model_.covariance.filter()));
  row_begin_ = std::move(table.row_begin);
  pair_observation_ = std::move(table.observation);
  pair_covariance_ = std::move(table.weight);
  model_.covariance.from_weights(pair_covariance_);

  assign_in_large_pages(misfits_, points_.size() * width_);
  assign_in_large_pages(g_, observations.size() * width_);
  assign_in_large_pages(s_, observations.size());
  for (std::uint32_t q = 0; q < points_.size(); ++q) {
    point_at_[points_[q]] = q;
    std::copy_n(targets.begin() + static_cast<std::ptrdiff_t>(q * channels_), channels_,
                misfits_.begin() + static_cast<std::ptrdiff_t>(q * width_));
    for (std::uint64_t i = row_begin_[q]; i < row_begin_[q + 1]; ++i) {
      double* g = &g_[pair_observation_[i] * width_];
      const double covariance = pair_covariance_[i];
      for (std::size_t c = 0; c < channels_; ++c) g[c] += covariance * misfits_[q * width_ + c];
      s_[pair_observation_[i]] += covariance * covariance;
    }
  }
  if (points_.size() < observations.size()) terms_near_.resize(observations.size());
  for (std::uint32_t p = 0; p < observation_count(); ++p) increments_[p] = fresh_increment(p);
}

double LocalAnalysis::gain_factor(std::uint32_t p) const {
  const double error_variance = model_.error_ratio * model_.error_ratio;
  if (retained_[p]) return 1 / (std::min(variances_[p], (1 - kLeastMargin) * error_variance) - error_variance);
  return 1 / (std::max(variances_[p], 0.0) + error_variance);
}

double LocalAnalysis::fresh_increment(std::uint32_t p) const {
  const double k = gain_factor(p);
  const double* g = &g_[p * width_];
  const double* departure = &departures_[p * channels_];
  double along = 0, squared = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    along += departure[c] * g[c];
    squared += departure[c] * departure[c];
  }
  return k * ((k * squared - model_.coverage) * s_[p] - 2 * along);
}

// near_ and column_: the observations within reach of p, and the column of C there.
void LocalAnalysis::find_column(std::uint32_t p) {
  if (const std::uint32_t q = point_at_[p]; q != kNone) {
    const auto begin = static_cast<std::ptrdiff_t>(row_begin_[q]), end = static_cast<std::ptrdiff_t>(row_begin_[q + 1]);
    near_.assign(pair_observation_.begin() + begin, pair_observation_.begin() + end);
    column_.assign(pair_covariance_.begin() + begin, pair_covariance_.begin() + end);
    return;
  }
  const GaussianFilter filter = model_.covariance.filter();
  tree_.radius_search(places_.of(p), filter.radius_km(), neighbours_);
  near_.clear();
  column_.clear();
  for (const Neighbour& neighbour : neighbours_) {
    if (places_.group_of(neighbour.index) != places_.group_of(p)) continue;
    near_.push_back(neighbour.index);
    column_.push_back(neighbour.distance_squared);
  }
  filter.weigh(column_, column_.data());
  model_.covariance.from_weights(column_);
  add_terms(p);
}

void LocalAnalysis::add_terms(std::uint32_t p) {
  for (std::size_t i = 0; i < near_.size(); ++i) work_[near_[i]] = column_[i];
  for (const std::uint32_t number : terms_near_[p]) {
    const Term& term = terms_[number];
    const auto place = std::lower_bound(term.observations.begin(), term.observations.end(), p);
    const double factor = term.sign * term.u[static_cast<std::size_t>(place - term.observations.begin())];
    // What is beyond the reach of p is changed too, and never read.
    subtract_multiple(term.observations.data(), term.u.data(), term.u.size(), factor, work_.data());
  }
  for (std::size_t i = 0; i < near_.size(); ++i) column_[i] = work_[near_[i]];
}

void LocalAnalysis::update_rows(std::uint32_t p, double k) {
  std::vector<double> misfit(width_), misfit_to(width_);
  Touched touched{touched_.data(), 0};
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const std::uint32_t q = point_at_[near_[i]];
    if (q == kNone) continue;
    const double step = k * column_[i];
    double* at_point = &misfits_[q * width_];
    std::copy_n(at_point, width_, misfit.begin());
    for (std::size_t c = 0; c < channels_; ++c) at_point[c] -= step * departures_[p * channels_ + c];
    std::copy_n(at_point, width_, misfit_to.begin());
    const std::uint64_t begin = row_begin_[q], end = row_begin_[q + 1];
    update_any_row(
        Row{&pair_observation_[begin], &pair_covariance_[begin], end - begin, step, misfit.data(), misfit_to.data()},
        Moved{column_at_.data(), changed_at_.data(), g_.data(), s_.data(), step_}, width_, touched);
  }
  touched_count_ = touched.count;
}

void LocalAnalysis::update_observations(std::uint32_t p, double k) {
  const std::vector<double> departure(departures_.begin() + static_cast<std::ptrdiff_t>(p * channels_),
                                      departures_.begin() + static_cast<std::ptrdiff_t>((p + 1) * channels_));
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const std::uint32_t other = near_[i];
    variances_[other] -= k * column_[i] * column_[i];
    for (std::size_t c = 0; c < channels_; ++c) departures_[other * channels_ + c] -= k * column_[i] * departure[c];
    column_at_[other] = 0;
    if (changed_at_[other] == step_) continue;
    changed_at_[other] = step_;
    touched_[touched_count_++] = other;
  }
}

// Or forgets the last one, where p undoes its own change.
void LocalAnalysis::keep_term(std::uint32_t p, double k) {
  if (p == last_changed_) {
    for (const std::uint32_t other : terms_.back().observations) terms_near_[other].pop_back();
    terms_.pop_back();
    last_changed_ = kNone;
    return;
  }
  last_changed_ = p;
  for (const std::uint32_t other : near_) terms_near_[other].push_back(static_cast<std::uint32_t>(terms_.size()));
  const double root = std::sqrt(std::abs(k));
  for (double& element : column_) element *= root;
  terms_.push_back({near_, column_, k < 0 ? -1.0 : 1.0});
}

void LocalAnalysis::change_state(std::uint32_t p) {
  ++step_;
  fallen_.clear();
  find_column(p);
  const double k = gain_factor(p);
  for (std::size_t i = 0; i < near_.size(); ++i) column_at_[near_[i]] = column_[i];
  update_rows(p, k);
  update_observations(p, k);
  if (!terms_near_.empty()) keep_term(p, k);
  retained_[p] = !retained_[p];
  retained_count_ += retained_[p] ? 1 : -1;
  for (const std::uint32_t other : std::span(touched_).first(touched_count_)) {
    const double before = increments_[other];
    increments_[other] = fresh_increment(other);
    if (increments_[other] < before) fallen_.push_back(other);
  }
}

std::vector<std::uint32_t> LocalAnalysis::retained() const {
  std::vector<std::uint32_t> result;
  for (std::uint32_t p = 0; p < retained_.size(); ++p)
    if (retained_[p]) result.push_back(p);
  return result;
}

double LocalAnalysis::error_sum() const {
  double sum = 0;
  for (std::size_t q = 0; q < points_.size(); ++q) {
    for (std::size_t c = 0; c < channels_; ++c) sum += misfits_[q * width_ + c] * misfits_[q * width_ + c];
    sum += model_.coverage * variances_[points_[q]];
  }
  return sum;
}

}  // namespace thin
