#pragma once

#include "libthin/estimation/bandwidth.h"
#include "libthin/thinning/greedy.h"
#include "libthin/thinning/refinement.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

// Estimation error analysis (thesis 6.3.2 to 6.3.4): greedy removal from the full set, or greedy insertion into the
// empty one, the error taken at the observations or at the vertices of the GME grid that have an observation within 3
// bandwidths. With update = "full" every step is the exact greedy choice. Then, if asked, refinement (refinement.h).
// Values should be innovations, or anomalies: where nothing is retained the estimate is 0.
class Eea : public ThinningMethod {
 public:
  enum class Direction { removal, insertion };
  enum class EvaluationPoints { observations, grid };

  Eea(Direction direction, EvaluationPoints points) : direction_(direction), points_(points) {}

  Traits traits() const override { return {}; }
  void declare_options(OptionTable& table) override;
  std::optional<Conflict> conflict() const override;
  bool stops_itself() const override { return max_estimation_error_k2_.has_value(); }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  Result<NeighbourhoodTable> table(const ThinningInput& input, double bandwidth_km) const;

  Direction direction_;
  EvaluationPoints points_;
  BandwidthOptions bandwidth_;
  int level_ = 6;
  Update update_ = Update::full;
  std::optional<double> max_estimation_error_k2_;
  RefinementOptions refinement_;
};

}  // namespace thin
