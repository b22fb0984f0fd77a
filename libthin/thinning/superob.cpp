#include "libthin/thinning/superob.h"

#include <algorithm>
#include <map>

#include "libthin/observations/geodesy.h"
#include "libthin/observations/mean_observations.h"

namespace thin {
namespace {

// The member nearest to the place, of several the first.
std::uint32_t nearest_member(const ObservationSet& set, const Retained& members, const Vector3& place_km) {
  return *std::min_element(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return chord_km(set.position_km[a], place_km) < chord_km(set.position_km[b], place_km);
  });
}

}  // namespace

void Superob::declare_options(OptionTable& table) {
  boxes_.declare(table);
}

Result<Choice> Superob::choose(const ThinningInput& input) const {
  const ObservationSet& set = input.observations;
  const BoxedObservations boxed(set, boxes_);
  // What different instruments measure has no mean.
  std::map<std::pair<std::uint64_t, Instrument>, Retained> boxes;
  for (std::uint32_t i = 0; i < set.size(); ++i) boxes[{boxed.cell[i], set.instrument[i]}].push_back(i);
  Choice choice;
  for (auto& [box, members] : boxes) choice.members.push_back(std::move(members));
  const ObservationSet means = mean_observations(set, choice.members);
  for (std::size_t i = 0; i < means.size(); ++i)
    choice.retained.push_back(nearest_member(set, choice.members[i], means.position_km[i]));
  return choice;
}

}  // namespace thin
