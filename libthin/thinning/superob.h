#pragma once

#include "libthin/thinning/box.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

// Superobbing: all observations of a box become one, their mean in place, time and values. Boxes are those of the
// method "box", or its GME cells. What goes on is not a subset of the input, so that it can be written as CF netCDF
// alone. The rival of every method that chooses: it halves the noise of four observations, where they retain it. O(n).
class Superob : public ThinningMethod {
 public:
  void declare_options(OptionTable& table) override;
  Traits traits() const override {
    return {.stops_at_count = false,
            .uses_values = false,
            .uses_places = false,
            .takes_priority = false,
            .keeps_apart = false,
            .makes_observations = true};
  }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  BoxOptions boxes_;
};

}  // namespace thin
