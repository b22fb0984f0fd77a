#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// Clusters of observations that are near to each other and measure alike, one of each retained (thesis 6.3.1).
//
// The metric is d² = |p - q|² + alpha² |f(p) - f(q)|² (6.8), over places (time among them, where it counts) and values.
// From one cluster of all, that with the largest error e (the sum of squared distances to its mean, 6.9) is split
// across the principal axis of its places, until retain_count clusters exist, or no error exceeds cluster_error; then
// Lloyd's iterations. Retained is the mean of each cluster: the member with the least sum of squared distances to the
// others; where there are priorities, of those of highest priority the one nearest to the centroid.
// Instruments that are thinned jointly share no cluster. libthin/foundation/lloyd_clustering.h has the costs.
class TopDownClustering : public ThinningMethod {
 public:
  Traits traits() const override { return {}; }
  void declare_options(OptionTable& table) override;
  bool stops_itself() const override { return cluster_error_km2_.has_value(); }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  double alpha_km_per_k_ = 100;
  std::optional<double> cluster_error_km2_;
  int lloyd_iterations_ = 100;
};

}  // namespace thin
