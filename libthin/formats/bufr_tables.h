#pragma once

// What the descriptors of a BUFR message stand for: elements (table B) and sequences (table D). They come from WMO, as
// ecCodes has them on disk, from a centre's own additions there, or from the file itself (bufr_tank_tables.h).

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "libthin/formats/bufr_header.h"
#include "libthin/foundation/result.h"

namespace thin {

struct BufrElement {
  enum class Kind : std::uint8_t { number, code_or_flags, text };
  Kind kind = Kind::number;
  int scale = 0;               // value = (number in the message + reference) / 10^scale
  std::int64_t reference = 0;  // not used for text
  unsigned width = 0;          // bits
};

class BufrTables {
 public:
  void add_element(int descriptor, const BufrElement& element) { elements_[descriptor] = element; }
  void add_sequence(int descriptor, std::vector<int> members) { sequences_[descriptor] = std::move(members); }
  // Asked, in the order of these calls, for what these tables do not have themselves.
  void put_above(std::shared_ptr<const BufrTables> beneath) { beneath_.push_back(std::move(beneath)); }
  bool empty() const { return elements_.empty() && sequences_.empty(); }

  // Null where no table has it. descriptor: as FXXYYY.
  const BufrElement* element(int descriptor) const;
  const std::vector<int>* sequence(int descriptor) const;

  // Every element that a message with these descriptors may hold. Sequences that are in no table hold none.
  std::set<int> elements_within(std::span<const int> descriptors) const;

 private:
  std::vector<std::shared_ptr<const BufrTables>> beneath_;
  std::unordered_map<int, BufrElement> elements_;
  std::unordered_map<int, std::vector<int>> sequences_;
};

// WMO's tables in the version that the message names, beneath the centre's own where ecCodes has those. Read once per
// process. Error input, where ecCodes doesn't have this version.
Result<std::shared_ptr<const BufrTables>> installed_tables(const BufrHeader& header);

}  // namespace thin
