#include "libthin/preparation/companion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"
#include "libthin/observations/instruments.h"
#include "libthin/preparation/space_time_index.h"

namespace thin {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// For each channel place of `set` the place of the same channel in `companions`.
std::vector<std::size_t> matching_places(const ObservationSet& set, const ObservationSet& companions) {
  std::vector<std::size_t> matching(set.channel_count(), kNone);
  for (std::size_t place = 0; place < set.channel_count(); ++place)
    for (std::size_t other = 0; other < companions.channel_count(); ++other)
      if (companions.channels[other] == set.channels[place] &&
          instrument_of_channel(companions, other) == instrument_of_channel(set, place))
        matching[place] = other;
  return matching;
}

bool same_field_of_view(std::int32_t a, std::int32_t b) {
  return a == b || a == kUnknownNumber || b == kUnknownNumber;
}

std::optional<std::uint32_t> nearest(const ObservationSet& set, std::size_t i, const ObservationSet& companions,
                                     const std::vector<std::uint32_t>& near) {
  std::optional<std::uint32_t> best;
  const auto key = [&](std::uint32_t j) {
    return std::tuple(chord_km(set.position_km[i], companions.position_km[j]),
                      std::abs(set.time_ms[i] - companions.time_ms[j]));
  };
  // `near` is in canonical order: of equals the first stays.
  for (const std::uint32_t j : near)
    if (same_field_of_view(set.field_of_view[i], companions.field_of_view[j]) && (!best || key(j) < key(*best)))
      best = j;
  return best;
}

}  // namespace

void CompanionOptions::declare(OptionTable& table) {
  table.add("companion_files", files,
            {.explanation = "files that hold first guesses for the same fields of view, for first_guess = "
                            "\"companion\": paths or patterns (*, ?)"});
  table.add(
      "companion_distance_km", distance_km,
      {.unit = "km",
       .maximum = 1000,
       .above = 0,
       .explanation = "a companion has the same satellite, instrument and field of view within this distance ..."});
  table.add("companion_minutes", minutes,
            {.unit = "min", .maximum = 1440, .above = 0, .explanation = "... and this time"});
}

void take_companions(ObservationSet& set, const ObservationSet& companions, const CompanionOptions& options) {
  set.first_guess_k.assign(set.values.size(), std::numeric_limits<double>::quiet_NaN());
  if (companions.first_guess_k.empty()) return;
  std::map<Sounder, std::vector<std::uint32_t>> sounders;
  for (const std::uint32_t j : canonical_order(companions)) sounders[sounder_of(companions, j)].push_back(j);
  const Nearness nearness{options.distance_km, std::llround(options.minutes * 60'000)};
  std::map<Sounder, SpaceTimeIndex> indexes;
  for (auto& [sounder, members] : sounders) indexes.try_emplace(sounder, companions, std::move(members), nearness);

  const std::vector<std::size_t> places = matching_places(set, companions);
  parallel_ranges(set.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      const auto index = indexes.find(sounder_of(set, i));
      if (index == indexes.end()) continue;
      index->second.near(set.position_km[i], set.time_ms[i], near);
      const std::optional<std::uint32_t> companion = nearest(set, i, companions, near);
      if (!companion) continue;
      for (std::size_t place = 0; place < places.size(); ++place)
        if (places[place] != kNone)
          set.first_guess_k[i * places.size() + place] =
              companions.first_guess_k[*companion * companions.channel_count() + places[place]];
    }
  });
}

}  // namespace thin
