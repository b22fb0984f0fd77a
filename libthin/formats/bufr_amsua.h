#pragma once

// AMSU-A soundings out of one BUFR message: WMO sequence 310009, or 310008 where a centre uses the longer HIRS one for
// all ATOVS sounders. Other descriptors may stand before and behind (a quality block 222000, say).

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "libthin/formats/bufr_header.h"
#include "libthin/formats/eccodes_message.h"
#include "libthin/observations/observation_set.h"

namespace thin {

constexpr int kAmsuAChannelCount = 15;
constexpr int kFirstAmsuACode = 28;  // code table 002150: 28..42 are AMSU-A's channels 1..15

// What became of a message. `message` is open and decoded unless failed.
struct AmsuAMessage {
  enum class State {
    amsua,       // at least one subset is AMSU-A
    other_kind,  // nothing is wrong with it, but it holds something else
    failed,      // it should hold soundings, but can't be decoded
  } state = State::failed;
  std::string reason;  // where not amsua: one sentence
  std::string remedy;  // where not amsua
  std::optional<EccodesMessage> message;
};

// Decodes the message as far as it takes to tell whether it is AMSU-A: by satelliteSensorIndicator, or where that is
// missing, by channel numbers that are all AMSU-A's. Messages without an ATOVS sequence are not given to ecCodes.
AmsuAMessage open_amsua(std::span<const std::uint8_t> bytes, const BufrHeader& header);

// Appends the soundings of an `amsua` message to `into` (channels 1..15), with source.message = message_number. Returns
// how many subsets were left out for want of a position or a time, or for being another instrument's.
//
// Channel numbers may stand in any slot and differ between subsets; of two slots with the same channel the first with a
// temperature counts. A channel without slot, or with a missing temperature, is NaN.
Result<std::uint32_t> append_soundings(const AmsuAMessage& amsua, const BufrHeader& header,
                                       std::uint32_t message_number, ObservationSet& into);

}  // namespace thin
