#pragma once

// Optimal interpolation in observation space (thesis eq. 6.7) for the judging of thinned sets:
//   x_a = C_xy (C_yy + rho² I)^-1 y,
// y the innovations, C the correlation of background errors, rho the observation error in units of the background's.
// The scale of C cancels, so that rho and the length are all that there is to choose.
//
// C(d) is Gaspari and Cohn's function (1999, eq. 4.10) that has the curvature of exp(-d²/2L²) at 0 and is within 0.03
// of it everywhere; it ends at 3.65 L. A Gaussian that is cut at 3 L isn't positive definite: with dense observations
// and small rho the system would have no meaning.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// 1 at 0, 0 from 3.65 length_km on; d is the chord, km.
double background_correlation(double distance_km, double length_km);

class OptimalInterpolation {
 public:
  // O((n + m) log n + pairs); 8 bytes for each pair of observations, or of observation and target, within 3.65 L.
  // REQUIRES: length_km > 0
  OptimalInterpolation(std::span<const Vector3> observations_km, std::span<const Vector3> targets_km, double length_km);

  // values: n x channels. For each ratio m x channels: the analysis less the background at the targets; 0 where no
  // observation is in reach. By conjugate gradients, to `tolerance` of the values' length, for all ratios at once (they
  // share the Krylov space: Jegerlehner 1996, hep-lat/9612014). The same bits for any number of threads.
  // REQUIRES: every ratio > 0
  std::vector<std::vector<double>> estimates(std::span<const double> values, std::size_t channels,
                                             std::span<const double> error_ratios, double tolerance = 1e-7) const;
  std::vector<double> estimate(std::span<const double> values, std::size_t channels, double error_ratio) const;

 private:
  struct Rows {  // compressed sparse rows
    std::vector<std::size_t> begin;
    std::vector<std::uint32_t> column;
    std::vector<float> weight;
  };
  template <std::size_t Block>
  static void multiply_block(const Rows& rows, const double* x, std::size_t channels, double* product);
  struct Shifted;
  static Rows rows_between(std::span<const Vector3> from, std::span<const Vector3> to, double length_km);
  static void multiply(const Rows& rows, std::span<const double> x, std::size_t channels, std::vector<double>& product);
  std::vector<std::vector<double>> solve(std::span<const double> values, std::size_t channels,
                                         std::span<const double> error_ratios, double tolerance) const;

  static void advance(Shifted& system, std::span<const double> residual, std::span<const double> step,
                      std::span<const double> step_before, std::span<const double> turn,
                      std::span<const double> turn_before);

  Rows among_observations_, at_targets_;
};

}  // namespace thin
