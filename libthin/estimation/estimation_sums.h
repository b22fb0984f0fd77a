#pragma once

// The sums behind the estimation error while observations are retained or given up one by one.
//
// With S_q = sum of w f and Z_q = sum of w over the retained, m = S_q / Z_q, r = est_P0(q) and d = m - r, giving p up
// changes the error at q by  2a d.(m - f) + a² |m - f|²,  a = w / (Z_q - w);  retaining it by the same with
// a = -w / (Z_q + w). With nothing retained the estimate is 0. The increment of p is what changing its state adds to
// |Q| E: the sum of these over the evaluation points within reach of p.
//
// Multiplied out, the change is  2a (d.m - d.f) + a² (m.m - 2 m.f + f.f):  of its products d.m and m.m belong to the
// point and f.f to the observation, so that two are left to take over the channels, with two lines of memory for each
// pair. Where a is large, and the multiplied-out form loses digits, the change is taken from the two estimates instead.
//
// With tracking, the pairs of a row stand with the retained in front, the change at q that each would cause is cached,
// and increments follow it by differences, four pairs at a time.
//
// S_q and Z_q are updated in place, and summed afresh whenever Z_q has halved or kFreshAfter updates have passed, so
// that rounding never outweighs what remains: the sums stay within 1e-9 of a recomputation.
//
// Memory: kBytesPerEntry per pair of the table. Time per change of state: the pairs of the points within reach.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libthin/estimation/neighbourhood_table.h"

namespace thin {

// What is kept of one evaluation point beside S and r.
struct PointSums {
  std::uint64_t row_begin;
  std::uint32_t row_size;
  std::uint32_t retained_count;
  std::uint32_t changed_at;
  std::uint32_t updates;       // since summed afresh
  double weight_sum;           // Z
  double largest_weight_sum;   // since summed afresh
  double one_over_weight_sum;  // 0 where nothing is retained
  double mean_squared;         // m.m
  double mean_by_deviation;    // m.d
};

class EstimationSums {
 public:
  enum class Start { with_all, with_none };

  // values: n x channels, none missing.
  EstimationSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels, Start start);

  // Which increments `change_state` keeps up to date; computes them all.
  enum class Track { nothing, retained, given_up, both };
  void track(Track which);

  // Gives up p if it is retained, retains it if not. While tracking, the tracked increments are brought up to date, and
  // fallen() lists the observations whose tracked increment may have fallen; some more than once.
  void change_state(std::uint32_t p);
  std::span<const std::uint32_t> fallen() const { return std::span(fallen_).first(fallen_count_); }

  // REQUIRES: tracking covers p's state
  double tracked_increment(std::uint32_t p) const { return increments_[p]; }

  // The same, straight from the sums: equal to rounding, at the cost of the channels.
  double increment(std::uint32_t p) const;

  // Those of all at once, sooner than one by one; read with tracked_increment until the first change of state.
  // REQUIRES: all are retained, or none
  void compute_increments();

  // What giving up `out` and retaining `in` together would add to |Q| E.
  // REQUIRES: is_retained(out), !is_retained(in)
  double swap_increment(std::uint32_t out, std::uint32_t in);

  // An observation that shares an evaluation point with p; which one, by two numbers in [0, 1). REQUIRES: p has a point
  std::uint32_t observation_near(std::uint32_t p, double which_point, double which_pair) const;

  // Counts changes of state; the increment of p is as it was at `step` unless changed_since(p, step).
  std::uint32_t step() const { return step_; }
  bool changed_since(std::uint32_t p, std::uint32_t step) const;

  bool is_retained(std::uint32_t p) const { return retained_[p]; }
  std::size_t retained_count() const { return retained_count_; }
  std::vector<std::uint32_t> retained() const;  // ascending
  std::size_t observation_count() const { return retained_.size(); }
  std::size_t evaluation_point_count() const { return points_.size(); }

  // |Q| E(P). O(|Q| channels), from the sums.
  double error_sum() const;

  // For tests: S_q and Z_q at evaluation point q.
  double weight_sum(std::size_t q) const { return points_[q].weight_sum; }
  double value_sum(std::size_t q, std::size_t channel) const { return value_sums_[q * width_ + channel]; }

 private:
  struct Column {
    const std::uint32_t* points;
    const double* weights;
    std::size_t size;
  };

  Column column(std::uint32_t p) const;
  void sum_afresh(std::size_t q);
  void update_points(std::uint32_t p);
  void part_rows();
  void move_pair(std::size_t q, std::uint32_t p);
  // What p changing its state would change at each point of its column.
  void column_changes(std::uint32_t p, const Column& near, std::vector<double>& result) const;
  double careful_pair_change(std::size_t q, std::uint32_t p, double weight) const;
  double change_to(std::size_t q, double weight_sum, std::uint32_t out, double weight_out, std::uint32_t in,
                   double weight_in) const;
  void fetch(std::size_t q) const;
  void refresh_row(std::size_t q);
  void refresh_pairs(std::size_t q, std::uint32_t begin, std::uint32_t end, bool retained, double* changes);

  std::size_t width_;               // channels, padded to whole groups of lanes
  std::vector<double> values_;      // n x width
  std::vector<double> squares_;     // n: f.f
  std::vector<double> references_;  // |Q| x width: est_P0
  std::vector<double> value_sums_;  // |Q| x width: S
  std::vector<PointSums> points_;
  // Pairs by evaluation point.
  std::vector<std::uint32_t> pair_observation_;
  std::vector<double> pair_weight_;
  std::vector<double> pair_change_;  // that changing the observation's state would cause there; while tracked

  // Pairs by observation; empty where the table is symmetric: then column p is row p.
  std::vector<std::uint64_t> column_begin_;
  std::vector<std::uint32_t> column_point_;
  std::vector<double> column_weight_;

  Track track_ = Track::nothing;
  std::vector<double> increments_;
  std::vector<std::uint8_t> retained_;
  std::size_t retained_count_ = 0;
  std::vector<std::uint32_t> fallen_;  // of the last change of state, the first fallen_count_ of them
  std::size_t fallen_count_ = 0;
  std::vector<std::uint32_t> reached_;  // scratch: the column of the observation that changes state
  std::vector<double> reached_weight_;
  std::vector<double> deviation_;                      // scratch: d of one point
  mutable std::vector<double> changes_, changes_out_;  // scratch: of a column
  std::vector<double> weight_out_;  // scratch of swap_increment: of each point, its weight for `out`, or 0
  std::uint32_t step_ = 0;
};

}  // namespace thin
