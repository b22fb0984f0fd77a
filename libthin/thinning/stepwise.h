#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// Every step-th field of view of every step-th scan line, per satellite (thesis 6.5: every third in both directions).
// Lines and fields of view count by the numbers that they carry, so that the choice is the same however an orbit is cut
// into files. O(n). Errors: input, where the scan position of an observation is unknown.
class Stepwise : public ThinningMethod {
 public:
  Traits traits() const override {
    return {.stops_at_count = false, .uses_values = false, .uses_places = false, .takes_priority = false};
  }
  void declare_options(OptionTable& table) override;
  std::optional<Conflict> conflict() const override;
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  int step_ = 3;
  int line_offset_ = 0;
  int field_of_view_offset_ = 0;
};

}  // namespace thin
