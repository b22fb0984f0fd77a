#pragma once

// Soundings out of one BUFR message: AMSU-A, AMSU-B, MHS, HIRS, ATMS, by the table of bufr_sounders.h, in WMO's
// sequences (310008 to 310010, 310061), in NCEP's own, or element by element.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "libthin/formats/bufr_data.h"
#include "libthin/formats/bufr_header.h"
#include "libthin/formats/bufr_tank_tables.h"
#include "libthin/formats/observation_file.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// What became of a message. Keeps a reference to its bytes.
struct SoundingMessage {
  enum class State {
    soundings,   // at least one subset is of an instrument that is read
    tables,      // what the file's messages behind it are to be decoded with
    other_kind,  // nothing is wrong with it, but it holds something else
    failed,      // it should hold soundings, but can't be decoded
  } state = State::failed;
  std::string reason;                   // where other_kind or failed: one sentence
  std::string remedy;                   // where other_kind or failed
  BufrData data;                        // where soundings
  std::vector<Instrument> instruments;  // where soundings: of each subset; unknown for those that are not read
};

// Decodes the message as far as it takes to tell what it is. The instrument of a subset is what
// satelliteSensorIndicator or satelliteInstruments says; where both are missing, the one to which all its channel
// numbers belong, or ATMS in 310061. tables: those of the file so far; messages have to be opened in the file's order.
SoundingMessage open_soundings(std::span<const std::uint8_t> bytes, const BufrHeader& header, BufrFileTables& tables);

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
