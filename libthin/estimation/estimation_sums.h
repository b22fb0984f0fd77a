#pragma once

// The sums behind the estimation error while observations are retained or given up one by one.
//
// With S_q = sum of w f and Z_q = sum of w over the retained, m = S_q / Z_q and d = m - est_P0(q), giving p up changes
// the error at q by  2a d.(m - f) + a² |m - f|²,  a = w / (Z_q - w);  retaining it by the same with  f - m  and
// a = w / (Z_q + w). With nothing retained the estimate is 0. The increment of p is what changing its state adds to
// |Q| E: the sum of these over the evaluation points within reach of p.
//
// The pairs of a row stand with the retained in front, so that a pass over one kind meets no other. With tracking, the
// change at q that each pair would cause is cached, and increments follow it by differences.
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

class EstimationSums {
 public:
  enum class Start { with_all, with_none };

  // values: n x channels, none missing.
  EstimationSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels, Start start);

  // Which increments `change_state` keeps up to date; computes them all.
  enum class Track { nothing, retained, given_up, both };
  void track(Track which);

  // Gives up p if it is retained, retains it if not. While tracking, the tracked increments are brought up to date, and
  // `changed` (if given) gets, once each, the observations whose tracked increment may differ now.
  void change_state(std::uint32_t p, std::vector<std::uint32_t>* changed = nullptr);

  // REQUIRES: tracking covers p's state
  double tracked_increment(std::uint32_t p) const { return increments_[p]; }

  // The same, straight from the sums: equal to rounding, at the cost of the channels.
  double increment(std::uint32_t p) const;

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
  struct Point {
    std::uint64_t row_begin;
    std::uint32_t row_size;
    std::uint32_t retained_count;  // pairs in front
    std::uint32_t changed_at;
    std::uint32_t updates;  // since summed afresh
    double weight_sum;
    double largest_weight_sum;  // since then
  };
  using Column = std::pair<const std::uint32_t*, const double*>;  // points, weights

  Column column(std::uint32_t p) const;
  std::size_t column_size(std::uint32_t p) const;
  void sum_afresh(std::size_t q);
  void update_mean(std::size_t q);
  void move_pair(std::size_t q, std::uint32_t p);
  void update_point(std::size_t q, std::uint32_t p, double weight);
  double pair_change(std::size_t q, std::uint32_t p, double weight) const;
  double swapped_pair_change(std::size_t q, std::uint32_t out, double weight_out, std::uint32_t in,
                             double weight_in) const;
  void refresh_row(std::size_t q);
  void refresh_pairs_one_by_one(std::size_t q, std::uint32_t begin, std::uint32_t end);
  void mark_row(std::size_t q, std::vector<std::uint32_t>& changed);

  std::size_t width_;               // channels, padded to whole groups of lanes
  std::vector<double> values_;      // n x width
  std::vector<double> references_;  // |Q| x width: est_P0
  std::vector<double> value_sums_;  // |Q| x width: S
  std::vector<double> means_;       // |Q| x width: m, or 0
  std::vector<double> deviations_;  // |Q| x width: m - est_P0
  std::vector<Point> points_;
  // Pairs by evaluation point, the retained ones of each row in front.
  std::vector<std::uint32_t> pair_observation_;
  std::vector<double> pair_weight_;
  std::vector<double> pair_change_;  // that changing the observation's state would cause there, while tracked

  // Pairs by observation; empty where the table is symmetric: then column p is row p.
  std::vector<std::uint64_t> column_begin_;
  std::vector<std::uint32_t> column_point_;
  std::vector<double> column_weight_;

  Track track_ = Track::nothing;
  std::vector<double> increments_;
  std::vector<std::uint8_t> retained_;
  std::size_t retained_count_ = 0;
  std::vector<std::uint32_t> marked_at_;  // the step at which an observation was last put on `changed`
  std::vector<std::uint32_t> reached_;    // scratch: the column of the observation that changes state
  std::vector<double> reached_weight_;
  std::vector<double> weight_out_;  // scratch of swap_increment: of each point, its weight for `out`, or 0
  std::uint32_t step_ = 0;
};

}  // namespace thin
