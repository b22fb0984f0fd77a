#include "libthin/preparation/space_time_index.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {

namespace {

constexpr int kDimension = 4;

}  // namespace

SpaceTimeIndex::SpaceTimeIndex(const ObservationSet& set, std::vector<std::uint32_t> members, const Nearness& nearness)
    : observations_(set),
      members_(std::move(members)),
      nearness_(nearness),
      origin_ms_(members_.empty() ? 0 : set.time_ms[members_.front()]),
      tree_({}, kDimension) {
  assert(nearness.distance_km > 0 && nearness.time_ms > 0);
  std::vector<double> coordinates;
  coordinates.reserve(members_.size() * kDimension);
  for (const std::uint32_t i : members_) {
    const Vector3& p = set.position_km[i];
    coordinates.insert(coordinates.end(), {p.x, p.y, p.z, scaled_time(set.time_ms[i])});
  }
  tree_ = KdTree(coordinates, kDimension);
}

// In units of distance: the limit of time is as far as the limit of distance.
double SpaceTimeIndex::scaled_time(std::int64_t time_ms) const {
  return static_cast<double>(time_ms - origin_ms_) * (nearness_.distance_km / static_cast<double>(nearness_.time_ms));
}

void SpaceTimeIndex::near(const Vector3& position_km, std::int64_t time_ms, std::vector<std::uint32_t>& found) const {
  // The ball around the cylinder of the two limits, a little wider against rounding; the limits decide.
  const double radius = nearness_.distance_km * std::numbers::sqrt2 * (1 + 1e-9);
  const std::array<double, kDimension> query = {position_km.x, position_km.y, position_km.z, scaled_time(time_ms)};
  thread_local std::vector<Neighbour> neighbours;
  tree_.radius_search(query, radius, neighbours);
  found.clear();
  for (const Neighbour& neighbour : neighbours) {
    const std::uint32_t i = members_[neighbour.index];
    if (std::abs(observations_.time_ms[i] - time_ms) <= nearness_.time_ms &&
        chord_km(observations_.position_km[i], position_km) <= nearness_.distance_km)
      found.push_back(i);
  }
}

}  // namespace thin
