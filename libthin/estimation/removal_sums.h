#pragma once

// The sums behind the estimation error while observations are removed one by one.
//
// With S_q = sum of w f and Z_q = sum of w over the retained, m = S_q / Z_q and d = m - est_P0(q), taking p out changes
// the error at q by  2a d.(m - f) + a² |m - f|²,  a = w / (Z_q - w);  taking the last one out leaves the estimate 0.
// The increment of p, |Q| (E(P \ {p}) - E(P)), is the sum of these over the evaluation points within reach of p.
//
// S_q and Z_q are updated in place, and summed afresh from the retained whenever Z_q has halved, so that the rounding
// left behind by large removed weights never outweighs what remains: the sums stay within 1e-9 of a recomputation.
// The change at q that p would cause is cached for each pair, and the increment of p follows it by differences. Rows
// are passed through in memory order, and compacted to their retained pairs on the way.
//
// Memory: about 32 bytes per pair of the table. Time per removal: the pairs of the evaluation points within reach.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/estimation/neighbourhood_table.h"

namespace thin {

class RemovalSums {
 public:
  // values: n x channels, none missing. The full set is retained.
  RemovalSums(NeighbourhoodTable table, std::span<const double> values, std::size_t channels);

  // Computes the increments of all, for `remove` with full updating and for tracked_increment.
  void track_increments();

  // Takes p out. With `changed`: brings the increments of all that are still retained up to date, and appends to
  // `changed`, once each, those that may differ now. REQUIRES: is_retained(p); with `changed`: track_increments()
  // before
  void remove(std::uint32_t p, std::vector<std::uint32_t>* changed = nullptr);

  // As of the last removal. REQUIRES: every removal was with `changed`
  double tracked_increment(std::uint32_t p) const { return increments_[p]; }

  // The same, straight from the sums: equal to rounding, at the cost of the channels.
  double increment(std::uint32_t p) const;

  // Counts removals; the increment of p is as it was at `step` unless changed_since(p, step).
  std::uint32_t step() const { return step_; }
  bool changed_since(std::uint32_t p, std::uint32_t step) const;

  bool is_retained(std::uint32_t p) const { return retained_[p]; }
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
    std::uint32_t row_size;  // pairs that may still be retained
    std::uint32_t retained_count;
    std::uint32_t changed_at;
    double weight_sum;
    double weight_sum_when_summed;
  };

  void sum_afresh(std::size_t q);
  void update_means(std::size_t q);
  void take_out(std::size_t q, std::uint32_t p, double weight);
  double pair_change(std::size_t q, std::uint32_t p, double weight) const;
  void refresh_row(std::size_t q);
  void refresh_short_row(std::size_t q);
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
  std::vector<double> pair_change_;  // that taking the observation out would cause there

  std::vector<std::uint64_t> column_begin_;
  std::vector<std::uint32_t> column_point_;
  std::vector<double> column_weight_;

  std::vector<double> increments_;
  std::vector<std::uint8_t> retained_;
  std::vector<std::uint32_t> marked_at_;  // the step at which an observation was last put on `changed`
  std::uint32_t step_ = 0;
};

}  // namespace thin
