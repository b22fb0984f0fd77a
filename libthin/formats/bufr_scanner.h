#pragma once

// Finds the BUFR messages in a file that may hold anything else between them: GTS envelopes, padding, stray bytes,
// damaged messages. O(file size); reads nothing outside the bytes that it is given, whatever they are.
//
// A message is "BUFR", an edition of 2 to 4, a length at whose end stands "7777", and sections that fit into it. Only
// then is it jumped over as one; after anything else the search goes on four bytes later. So neither "BUFR" in a data
// section nor "BUFR" in stray bytes is taken for a message.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libthin/formats/bufr_header.h"

namespace thin {

struct BufrMessage {
  std::size_t offset = 0;
  std::size_t length = 0;  // "BUFR" through "7777"
  BufrHeader header;
};

// One or more messages without a gap, and the GTS envelope around them (formats/gts_bulletin.h), where there is one.
struct Bulletin {
  std::size_t first_message = 0;
  std::size_t message_count = 0;
  std::size_t heading_offset = 0;
  std::size_t heading_size = 0;
  bool has_length_prefix = false;
  std::size_t trailer_offset = 0;
  std::size_t trailer_size = 0;
};

// Bytes that belong to no message and no envelope.
struct UnusedBytes {
  std::size_t message = 0;  // number of messages in front of it
  std::size_t offset = 0;
  std::size_t size = 0;
  bool padding = false;  // nothing but NUL, space and line ends
  std::string reason;    // why the message that seems to begin here is none; empty for stray bytes
};

struct BufrScan {
  std::vector<BufrMessage> messages;
  std::vector<Bulletin> bulletins;  // together they hold every message once, in order
  std::vector<UnusedBytes> unused;
  std::optional<std::size_t> cut_offset;  // of a last message, or heading, that the file ends in the midst of
  bool has_end_marker = false;            // the GTS prefix of length 0 after the last bulletin
};

BufrScan scan_bufr(std::span<const std::uint8_t> bytes);

}  // namespace thin
