#pragma once

// What sections 0, 1 and 3 of one BUFR message say (WMO Manual on Codes, FM 94; editions 2, 3 and 4), read without
// any tables: enough to tell messages of different kinds apart, and to keep those whose sections do not fit out of what
// trusts them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libthin/foundation/result.h"

namespace thin {

constexpr std::size_t kBufrSection0Size = 8;
constexpr std::size_t kBufrSection5Size = 4;  // "7777"
constexpr int kCentreNcep = 7;                // common code table C-11
constexpr int kCentreEcmwf = 98;

struct BufrHeader {
  int edition = 0;
  int centre = 0;
  int sub_centre = 0;
  int data_category = 0;      // BUFR table A
  int data_sub_category = 0;  // the originating centre's own
  int master_table = 0;       // 0: meteorology
  int master_table_version = 0;
  int local_table_version = 0;
  int subset_count = 0;
  bool compressed = false;
  std::size_t section2_offset = 0;  // from the first byte of the message
  std::size_t section2_length = 0;  // 0 where there is none
  std::size_t section3_offset = 0;
  std::size_t section4_offset = 0;
  std::size_t section4_length = 0;  // with its own four bytes of length and padding
  std::vector<int> descriptors;     // unexpanded, as FXXYYY: 310009
};

// Unsigned big-endian number of `count` bytes at `offset`. REQUIRES: they are there.
std::uint32_t big_endian(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count);
void put_big_endian(std::span<std::uint8_t> bytes, std::size_t offset, std::size_t count, std::uint32_t value);

// message: from "BUFR" through "7777". Error input, where the sections do not fit into it.
Result<BufrHeader> parse_bufr_header(std::span<const std::uint8_t> message);

}  // namespace thin
