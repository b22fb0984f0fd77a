#pragma once

// One BUFR message with fewer of its subsets. Numbers are never decoded to values: what is written is the bits that
// came, so that every value of every key, missing ones, quality information and characters too, stays what it was.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/formats/bufr_data.h"
#include "libthin/formats/bufr_header.h"

namespace thin {

// Sections 0 to 3 stay but for the length and the number of subsets; compression stays. In compressed messages the base
// of each element becomes the smallest of the retained numbers again, its increments as narrow as that allows.
// REQUIRES: data walked from this message; subsets: some, ascending, without duplicates, each below the message's count
std::vector<std::uint8_t> extract_subsets(std::span<const std::uint8_t> message, const BufrHeader& header,
                                          const BufrData& data, std::span<const std::uint32_t> subsets);

}  // namespace thin
