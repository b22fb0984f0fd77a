#pragma once

// The analysis that optimal interpolation makes of the retained observations, and how sure it is of it, while
// observations are retained or given up one by one.
//
// Everything is in units of the background error s: B(p, p) = 1, observation errors have the variance r² = rho². With
// nothing retained the analysis a is 0 (values are innovations) and its error covariance C is B. Let d = f(p) - a(p),
// C_p the column of p. By the formula of Sherman and Morrison, retaining p makes of them
//   a + k d C_p   and   C - k C_p C_p^T,   k = 1 / (C_pp + r²),
// and giving p up again the same with k = 1 / (C_pp - r²), below 0 since C_pp < r² where p is retained. What matters is
//   J = sum over q in Q of |T_q - a_q|² + lambda sigma² C_qq,
// T being the target and sigma² the variance of the signal, summed over channels: lambda weighs coverage where the
// values say nothing. With g_p = sum_q C_qp (T_q - a_q) and s_p = sum_q C_qp² a change of p's state changes J by
//   -2 k d.g_p + k² |d|² s_p - lambda sigma² k s_p.
// Channels share C: they have the same L and rho, and their values are in units that make them count alike.
//
// C is local: pairs beyond the reach of the covariance are and stay 0. It is kept between evaluation points and
// observations alone. The column of an observation that is no evaluation point, needed in full when its state changes,
// is put together from B and the rank-one terms so far. Because of the cut-off C depends on the order of the changes,
// in the third digit or so; giving up what was retained last undoes it exactly.
//
// Time for each change: the pairs of the evaluation points within reach, and with evaluation points thinned as much
// again for the terms. Memory: 12 bytes for each pair of evaluation point and observation, and 16 for each observation
// within reach of each one retained (analysis_memory.h).

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/estimation/background_covariance.h"
#include "libthin/estimation/estimation_sums.h"
#include "libthin/estimation/places.h"
#include "libthin/foundation/kd_tree.h"

namespace thin {

struct AnalysisModel {
  BackgroundCovariance covariance;
  double error_ratio = 0.4;  // rho
  double coverage = 0;       // lambda sigma²
};

class LocalAnalysis {
 public:
  // values: n x channels, none missing. evaluation_points: indices of observations, ascending. targets: one row of
  // channels for each of them.
  LocalAnalysis(const Places& observations, std::span<const double> values, std::size_t channels,
                std::vector<std::uint32_t> evaluation_points, std::span<const double> targets,
                const AnalysisModel& model);

  // Retains p, or gives it up. All increments are right afterwards; fallen() lists the observations whose increment
  // fell.
  void change_state(std::uint32_t p);
  std::span<const std::uint32_t> fallen() const { return fallen_; }

  // What changing the state of p would add to J.
  double tracked_increment(std::uint32_t p) const { return increments_[p]; }
  double increment(std::uint32_t p) const { return increments_[p]; }
  void track(EstimationSums::Track) {}  // all are, always
  void compute_increments() {}

  // Counts changes of state; the increment of p is as it was at `step` unless changed_since(p, step).
  std::uint32_t step() const { return step_; }
  bool changed_since(std::uint32_t p, std::uint32_t step) const { return changed_at_[p] > step; }

  bool is_retained(std::uint32_t p) const { return retained_[p]; }
  std::size_t retained_count() const { return retained_count_; }
  std::vector<std::uint32_t> retained() const;  // ascending
  std::size_t observation_count() const { return retained_.size(); }
  std::size_t evaluation_point_count() const { return points_.size(); }

  // J. O(|Q| channels).
  double error_sum() const;

  // At observation p: f - a, and C_pp.
  double departure(std::uint32_t p, std::size_t channel) const { return departures_[p * channels_ + channel]; }
  double variance(std::uint32_t p) const { return variances_[p]; }

 private:
  // A column of C times a factor, at some change of state: C -= sign u u^T.
  struct Term {
    std::vector<std::uint32_t> observations;
    std::vector<double> u;
    double sign;
  };

  void find_column(std::uint32_t p);
  void keep_term(std::uint32_t p, double k);
  void add_terms(std::uint32_t p);
  void update_rows(std::uint32_t p, double k);
  void update_observations(std::uint32_t p, double k);
  double fresh_increment(std::uint32_t p) const;
  double gain_factor(std::uint32_t p) const;

  std::size_t channels_;
  std::size_t width_;  // of the rows below: the channels, filled up
  AnalysisModel model_;
  const Places places_;
  KdTree tree_;

  // Pairs by evaluation point.
  std::vector<std::uint32_t> points_;    // the observation where each is
  std::vector<std::uint32_t> point_at_;  // of each observation the evaluation point there, or kNone
  std::vector<std::uint64_t> row_begin_;
  std::vector<std::uint32_t> pair_observation_;
  std::vector<double> pair_covariance_;
  std::vector<double> misfits_;  // |Q| x width: T - a

  // By observation.
  std::vector<double> g_;  // n x width
  std::vector<double> s_;
  std::vector<double> departures_;  // n x channels
  std::vector<double> variances_;
  std::vector<double> increments_;
  std::vector<std::uint8_t> retained_;
  std::size_t retained_count_ = 0;
  std::vector<double> column_at_;          // of the observation that changes state; 0 beyond its reach
  std::vector<std::uint32_t> changed_at_;  // the step at which its increment last changed

  std::vector<Term> terms_;                             // empty where all observations are evaluation points
  std::vector<std::vector<std::uint32_t>> terms_near_;  // by observation that is none: the terms that reach it

  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> near_;              // scratch: the observations within reach of the one that changes state
  std::vector<double> column_;                   // and its column there
  std::vector<double> work_;                     // n: of add_terms
  std::vector<std::uint32_t> touched_, fallen_;  // by the last change; the first touched_count_ of touched_
  std::size_t touched_count_ = 0;
  std::uint32_t last_changed_;  // giving it up or taking it back would undo the last term
  std::uint32_t step_ = 0;
};

}  // namespace thin
