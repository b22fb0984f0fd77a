#pragma once

// From a BUFR message of soundings to observations.

#include <cstdint>
#include <map>

#include "libthin/formats/bufr_soundings.h"
#include "libthin/formats/observation_file.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// Of each instrument a set of its own.
using SoundingSets = std::map<Instrument, ObservationSet>;

// Appends the soundings of a message to `into`, with source.message = message_number. Returns how many subsets were
// left out for want of a position or a time, or for being of an instrument that is not read.
//
// Channel numbers may stand in any slot and differ between subsets; of two slots with the same channel the first with a
// temperature counts. A channel without slot, or with a missing temperature, is NaN.
// REQUIRES: state == soundings
std::uint32_t append_soundings(const SoundingMessage& message, std::uint32_t message_number,
                               BufrTemperature temperature, SoundingSets& into);

}  // namespace thin
