#include "libthin/tools/instrument_parts.h"

#include <map>
#include <numeric>
#include <vector>

namespace thin {

Result<void> each_instrument(const ObservationSet& set, const InstrumentBody& body) {
  if (set.size() == 0) return {};
  std::map<Instrument, std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < set.size(); ++i) members[set.instrument[i]].push_back(i);
  if (members.size() == 1) return body(members.begin()->first, set, members.begin()->second);
  for (const auto& [instrument, indices] : members) {
    std::vector<std::size_t> places;
    for (std::size_t place = 0; place < set.channel_count(); ++place)
      if (set.measures(indices.front(), place)) places.push_back(place);
    if (Result<void> done = body(instrument, set.select(indices).select_channels(places), indices); !done) return done;
  }
  return {};
}

}  // namespace thin
