#pragma once

#include "libthin/thinning/greedy_removal.h"
#include "libthin/thinning/retain_target.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

// Estimation error analysis on a regular grid (thesis 6.3.3): greedy removal, the error taken at the vertices of the
// GME grid that have an observation within 3 bandwidths. With update = "full" every step is the exact greedy choice.
// Values should be innovations, or anomalies: where nothing is retained the estimate is 0.
class GridEea : public ThinningMethod {
 public:
  void declare_options(OptionTable& table) override;
  std::optional<Conflict> conflict() const override { return target_.conflict(); }
  Result<Retained> thin(const ObservationSet& observations) const override;
  std::optional<double> bandwidth_km() const override { return bandwidth_km_; }

 private:
  RetainTarget target_;
  double bandwidth_km_ = 100;
  int level_ = 6;
  Update update_ = Update::full;
};

}  // namespace thin
