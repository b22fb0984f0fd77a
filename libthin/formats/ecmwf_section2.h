#pragma once

// The optional section 2 as ECMWF fills it: 52 bytes, a key of its report data base. Layout as in ecCodes's
// bufr/rdb_key.def and section.3.def.

#include <cstdint>
#include <span>

#include "libthin/formats/bufr_header.h"

namespace thin {

// `extracted` is `original` with fewer subsets: makes the message length and the number of observations in its section
// 2 right, where they were right in the original. Anything but ECMWF's section 2 is left alone.
void correct_ecmwf_section2(std::span<const std::uint8_t> original, const BufrHeader& original_header,
                            std::span<std::uint8_t> extracted, const BufrHeader& extracted_header);

}  // namespace thin
