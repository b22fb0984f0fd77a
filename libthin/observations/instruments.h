#pragma once

// The sounders that soundings come from: their names in configurations and tables, and how they scan.

#include <optional>
#include <string>
#include <utility>

#include "libthin/observations/observation_set.h"

namespace thin {

// As instrument_name() writes it, any case, with or without its hyphen: "AMSU-A", "amsua".
std::optional<Instrument> find_instrument(const std::string& name);

// Fields of view in one scan line (NOAA KLM User's Guide, chapter 3; ATMS: 96); 0 where the instrument is unknown.
int fields_of_view_per_line(Instrument instrument);

// One instrument on one satellite, by the number in WMO's common code table C-5: what counts are kept apart by.
using Sounder = std::pair<std::int32_t, Instrument>;

// "NOAA-19 AMSU-A"; the satellite alone where the instrument is unknown.
std::string sounder_name(const Sounder& sounder);

inline Sounder sounder_of(const ObservationSet& observations, std::size_t observation) {
  return {observations.platform[observation], observations.instrument[observation]};
}

// The instrument whose channel stands at this place: unknown where the set does not say.
Instrument instrument_of_channel(const ObservationSet& observations, std::size_t channel_place);

}  // namespace thin
