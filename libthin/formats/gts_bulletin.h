#pragma once

// The envelope that the Global Telecommunication System puts around messages (WMO Manual on the GTS, attachment II-15):
//
//   LLLLLLLLFF  SOH CR CR LF nnn CR CR LF  TTAAii CCCC YYGGgg [BBB] CR CR LF  MESSAGE  CR CR LF ETX
//
// LLLLLLLL counts the bytes after FF; with FF = 01, SOH and the sequence number nnn and the end are left out. The
// prefix and the sequence number may be missing, and line ends be CR LF or LF: then only what is there is an envelope.
// A prefix with length 0 ends a file of bulletins.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thin {

struct GtsHeading {
  std::size_t size = 0;            // bytes in front of the message; 0 where there is no heading
  bool has_length_prefix = false;  // the first ten bytes are LLLLLLLLFF
};

// The heading that ends where `before` ends.
GtsHeading find_gts_heading(std::span<const std::uint8_t> before);

// Bytes of CR CR LF ETX (or what of it is there: at least ETX) that `after` begins with; 0 for none.
std::size_t gts_trailer_size(std::span<const std::uint8_t> after);

// Whether `rest` begins with the prefix of length 0 that ends a file.
bool is_gts_end_marker(std::span<const std::uint8_t> rest);
constexpr std::size_t kGtsLengthPrefixSize = 10;

// Whether `rest`, the end of a file, looks like the beginning of one more bulletin or message whose rest is missing.
bool is_cut_gts_heading(std::span<const std::uint8_t> rest);

// `bulletin` begins with a length prefix: makes its length right. The format digits stay.
void put_gts_length(std::span<std::uint8_t> bulletin);

}  // namespace thin
