#pragma once

// Which observations lie near a place and a time: a kd-tree over position and scaled time. O(n log n) to build.

#include <cstdint>
#include <vector>

#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// Both limits belong to "near".
struct Nearness {
  double distance_km;  // straight line
  std::int64_t time_ms;
};

class SpaceTimeIndex {
 public:
  // members: indices of `observations`, which must outlive the index. REQUIRES: distance_km > 0, time_ms > 0
  SpaceTimeIndex(const ObservationSet& observations, std::vector<std::uint32_t> members, const Nearness& nearness);

  // The members that are near, in the order of `members`. `found` is replaced. May be called by many threads.
  void near(const Vector3& position_km, std::int64_t time_ms, std::vector<std::uint32_t>& found) const;

 private:
  double scaled_time(std::int64_t time_ms) const;

  const ObservationSet& observations_;
  std::vector<std::uint32_t> members_;
  Nearness nearness_;
  std::int64_t origin_ms_;
  KdTree tree_;
};

}  // namespace thin
