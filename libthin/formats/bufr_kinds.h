#pragma once

// What a BUFR message that is not AMSU-A holds, named so that its owner recognises it, and what to do about it.

#include <string>

#include "libthin/formats/bufr_header.h"

namespace thin {

// The ATOVS sequences of WMO BUFR table D: 310011 (the field of view), then 19, 15 or 5 times 310012 (a channel).
constexpr int kHirsSequence = 310008;  // used for AMSU-A and MHS too, by some centres
constexpr int kAmsuASequence = 310009;
constexpr int kAmsuBSequence = 310010;

// Code table 002048, satelliteSensorIndicator.
constexpr int kSensorHirs = 0;
constexpr int kSensorAmsuA = 3;
constexpr int kSensorAmsuB = 4;
constexpr int kSensorMhs = 11;

// Whether one of the ATOVS sequences is among the descriptors, so that the sensor stands in the message.
bool is_atovs(const BufrHeader& header);

// What keeps ranks of elements from meaning what they mean in a lone ATOVS sequence; empty for nothing. Behind the
// sequence anything may follow; in front of it single elements may stand that it doesn't hold itself: they shift no
// rank. REQUIRES: is_atovs(header)
std::string unsuitable_atovs(const BufrHeader& header);

// "HIRS (sensor 0)"
std::string sensor_name(int sensor);

struct MessageKind {
  std::string name;    // "ATMS (310061)", "SYNOP or other surface data (data category 0)"
  std::string remedy;  // a sentence
};

// The kind of a message that is_atovs() does not hold for.
MessageKind kind_of(const BufrHeader& header);

// What to do about soundings of another instrument.
std::string other_sensor_remedy();

}  // namespace thin
