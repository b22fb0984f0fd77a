#pragma once

// One BUFR message in ecCodes's hands: owned handle, arrays by key, errors as ecCodes words them.
//
// ecCodes's own chatter on standard error is off from the first message on, for the whole process; what it says is kept
// for the next Error. One thread at a time may hold EccodesMessages: its context is one for the process.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"

struct grib_handle;

namespace thin {

// Whether this ecCodes has the tables that a message of this master table and version is decoded with. Where it hasn't,
// the message must not be opened: ecCodes 2.28 ends the process over it.
bool eccodes_has_tables(int master_table, int version);

class EccodesMessage {
 public:
  // bytes: one whole message; copied, so that ecCodes may change it. Error input, in ecCodes's words.
  static Result<EccodesMessage> open(std::span<const std::uint8_t> bytes);

  // Decodes section 4. Attributes of keys (units, widths) are not made: nothing here asks for them.
  Result<void> unpack();

  Result<long> number(const std::string& key) const;

  // All values of a key: `values` is replaced, missing ones are NaN. In a compressed message a key with rank, "#1#...",
  // has one value where it is constant, else one per subset; in an uncompressed message a key without rank has its
  // occurrences subset by subset. Error input, where the message has no such key.
  Result<void> numbers(const std::string& key, std::vector<double>& values) const;

  // The message with only these subsets (from 0, ascending, without duplicates), packed anew.
  // REQUIRES: unpack() was called, some subsets
  Result<std::vector<std::uint8_t>> extract_subsets(std::span<const std::uint32_t> subsets);

 private:
  struct Delete {
    void operator()(grib_handle* handle) const;
  };
  explicit EccodesMessage(grib_handle* handle) : handle_(handle) {}
  std::unique_ptr<grib_handle, Delete> handle_;
};

}  // namespace thin
