#pragma once

// BUFR tables that travel inside a file, as messages of data category 11 in front of the data that need them: NCEP's
// tanks (1bamua, 1bmhs, ...) and prepBUFR. Table B and D entries are text in elements 000010 to 000030 (BUFR Guide,
// WMO-No. 306, volume I.2, table D 300003 and 300004; NCEP's DX tables).

#include <cstdint>
#include <memory>
#include <span>

#include "libthin/formats/bufr_header.h"
#include "libthin/formats/bufr_tables.h"
#include "libthin/foundation/result.h"

namespace thin {

constexpr int kTablesCategory = 11;

// The tables in force at each message of one file. Nothing of it outlives the file or reaches another one.
class BufrFileTables {
 public:
  // Takes the tables of a message of category 11. Messages of tables without data between them add to one another; the
  // first behind data begins anew. Error input, where it can't be read: then the file has no tables of its own.
  Result<void> take(std::span<const std::uint8_t> message, const BufrHeader& header);

  // The next message in the file is one of data.
  void pass_data() { behind_data_ = true; }

  // What to decode that message with: the file's own tables above WMO's.
  // Error input, where there are neither.
  Result<std::shared_ptr<const BufrTables>> for_data(const BufrHeader& header);

  bool has_own() const { return own_ != nullptr; }

 private:
  std::shared_ptr<BufrTables> own_;
  std::shared_ptr<const BufrTables> installed_;  // of the last header that for_data() was asked about
  std::shared_ptr<const BufrTables> in_force_;   // own_ above installed_
  bool behind_data_ = false;
};

}  // namespace thin
