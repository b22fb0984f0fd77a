#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// One observation per box: latitude bands of equal height, each cut into boxes of nearly equal area; retained is the
// observation nearest to the centre of its box. O(n).
class Box : public ThinningMethod {
 public:
  void declare_options(OptionTable& table) override;
  Traits traits() const override { return {.stops_at_count = false, .uses_values = false, .uses_places = false}; }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  double horizontal_mesh_km_ = 75;
};

}  // namespace thin
