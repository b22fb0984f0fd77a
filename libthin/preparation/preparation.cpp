#include "libthin/preparation/preparation.h"

#include <fmt/format.h>

#include "libthin/observations/platforms.h"

namespace thin {

void PreparationOptions::declare(OptionTable& table) {
  screening.declare(table);
  first_guess.declare(table);
}

Result<Prepared> prepare(const ObservationSet& observations, const TimeWindow& window,
                         const PreparationOptions& options) {
  Prepared prepared;
  std::vector<std::uint32_t> in_window;
  for (const std::uint32_t i : canonical_order(observations)) {
    if (window.holds(observations.time_ms[i]))
      in_window.push_back(i);
    else
      ++prepared.outside_window;
  }
  const ObservationSet windowed = observations.select(in_window);

  Result<Screening> screening = screen(windowed, options.screening);
  if (!screening) return screening.error();
  std::vector<std::uint32_t> fit;
  for (std::uint32_t i = 0; i < windowed.size(); ++i) {
    PlatformTally& tally = prepared.platforms[windowed.platform[i]];
    ++tally.observations;
    if (screening->reasons[i] != ScreeningReason::none) {
      ++tally.screened[screening->reasons[i]];
      continue;
    }
    ++tally.prepared;
    fit.push_back(i);
    prepared.origin.push_back(in_window[i]);
  }

  for (const DeadChannel& dead : screening->dead)
    prepared.notes.push_back(fmt::format("channel {} is missing in {} of {} observations of {}{}", dead.channel,
                                         dead.missing, dead.observations, platform_name(dead.platform),
                                         options.screening.channels.empty() ? ": it is not used in this window" : ""));
  prepared.dead_channels = std::move(screening->dead);
  prepared.observations = windowed.select(fit).select_channels(screening->channel_places);
  subtract_first_guess(prepared.observations, options.first_guess, prepared.notes);
  return prepared;
}

}  // namespace thin
