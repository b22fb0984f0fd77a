#pragma once

// What a BUFR message holds that is not read, named so that its owner recognises it, and what to do about it.

#include <string>

#include "libthin/formats/bufr_header.h"

namespace thin {

// In the descriptors stands the sequence of ATMS (310061), so that all of it is ATMS.
bool is_atms(const BufrHeader& header);

// Whether it's worth looking for soundings in it: not, where its descriptors or its data category name something else.
// has_own_tables: the file brings tables, without which local descriptors say nothing.
bool may_hold_soundings(const BufrHeader& header, bool has_own_tables);

std::string sensor_name(int sensor);                // "AVHRR (sensor 5)", of code table 002048
std::string satellite_instrument_name(int number);  // "SSMIS (satellite instrument 908)", of common code table C-8

struct MessageKind {
  std::string name;    // "SSMIS (310025)", "SYNOP or other surface data (data category 0)"
  std::string remedy;  // a sentence
};

// The kind of a message that holds no soundings that are read.
MessageKind kind_of(const BufrHeader& header, bool has_own_tables);

// What to do about soundings of another instrument.
std::string other_sensor_remedy();

}  // namespace thin
