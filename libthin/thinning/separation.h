#pragma once

// Who stands too near to whom to be retained with it: thinning is also there to decorrelate observation errors.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// The observations nearer to each other than min_separation_km (chord), whatever their times; themselves not among
// them.
class Separation {
 public:
  // 0: everyone may stand anywhere. O(n log n + pairs).
  Separation(std::span<const Vector3> positions_km, double min_separation_km);

  bool is_demanded() const { return !begin_.empty(); }
  std::span<const std::uint32_t> too_near_to(std::uint32_t p) const {
    return is_demanded() ? std::span(near_).subspan(begin_[p], begin_[p + 1] - begin_[p])
                         : std::span<const std::uint32_t>();
  }

 private:
  std::vector<std::uint64_t> begin_;
  std::vector<std::uint32_t> near_;
};

}  // namespace thin
