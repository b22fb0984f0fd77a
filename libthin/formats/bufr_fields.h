#pragma once

// What the fields of a subset mean to a sounding, by the elements of bufr_sounders.h. A quality block (222000 and what
// is behind it) tells about other fields: it is left out of all of this.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/formats/bufr_data.h"
#include "libthin/formats/observation_file.h"

namespace thin {

// A channel number, and the first temperature behind it and in front of the next channel number.
struct BufrSlot {
  const BufrField* channel = nullptr;
  const BufrField* temperature = nullptr;
};

// In their order. Channel numbers without temperature make none: HIRS' visible channel has a radiance.
std::vector<BufrSlot> slots_of(const AlikeSubsets& group, BufrTemperature temperature);

// The first field of this element, or of the first element of the list that there is; all missing where there is none.
BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, int descriptor);
BufrColumn column_of(const BufrData& data, const AlikeSubsets& group, std::span<const int> elements);

// kUnknownNumber for what is missing, negative or beyond any number of its kind: a tank's tables may say anything.
std::int32_t number_or_unknown(double value);

// Why position or time of a subset can't be told: "latitude (descriptor 5001) stands 2 times in a subset, ...", since
// where there is a choice none is made. Empty where they can be told.
std::string ambiguous_place(const AlikeSubsets& group);

}  // namespace thin
