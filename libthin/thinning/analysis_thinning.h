#pragma once

#include "libthin/estimation/local_analysis.h"
#include "libthin/estimation/variogram.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

// Thinning for the analysis: the observations from which optimal interpolation makes of the innovations what it would
// make of all. Greedy insertion of the observation that lowers J most (estimation/local_analysis.h), each step the true
// minimum, then exchange while J falls. J = sum over evaluation points of |T - a|² + lambda sigma² C: the misfit of the
// analysis from the retained to the estimate from all, and where the values say nothing its uncertainty.
// Observations that their neighbours contradict are left out before.
class AnalysisThinning : public ThinningMethod {
 public:
  enum class LengthScales { automatic, one, two };

  Traits traits() const override { return {}; }
  void declare_options(OptionTable& table) override;
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  // The options with what the observations say where they say nothing.
  struct Resolved {
    std::optional<Variogram> variogram;
    BackgroundCovariance covariance;
    double error_ratio;
  };
  // The observations that are not left out as wrong.
  struct Believed {
    std::vector<std::uint32_t> indices;  // in the input, ascending
    Places places;
    std::vector<double> values;
    std::vector<double> priority;
    std::vector<Vector3> positions_km;

    Believed(const ThinningInput& input, const std::vector<double>& all_values,
             const std::vector<std::uint8_t>& is_wrong);
  };

  Resolved resolve(const ThinningInput& input, std::span<const double> values) const;
  std::vector<std::string> notes(const Resolved& resolved, const ThinningInput& input, const Believed& all,
                                 double retained_per_square_length) const;

  std::optional<double> correlation_length_km_;
  LengthScales length_scales_ = LengthScales::automatic;
  std::optional<double> error_ratio_;
  double coverage_weight_ = 0.2;
  double gross_error_check_ = 3;
  bool exchange_ = true;
  std::optional<double> evaluation_spacing_km_;
};

}  // namespace thin
