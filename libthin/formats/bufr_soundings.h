#pragma once

// BUFR messages that hold soundings: AMSU-A, AMSU-B, MHS, HIRS, ATMS, by the table of bufr_sounders.h, in WMO's
// sequences (310008 to 310010, 310061), in NCEP's own, or element by element.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/formats/bufr_data.h"
#include "libthin/formats/bufr_header.h"
#include "libthin/formats/bufr_tank_tables.h"
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

}  // namespace thin
