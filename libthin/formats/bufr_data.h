#pragma once

// Section 4 of a BUFR message, taken apart: where the value of every element of every subset stands, and what it is.
// (WMO Manual on Codes, volume I.2, FM 94 BUFR, regulations 94.5 and 94.6.)
//
// Nothing is decoded until it is asked for: a compressed message is walked from element to element, whatever the number
// of its subsets. Bytes and descriptors may be anything: what does not fit is an error, at a cost bounded by the length
// of the message.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "libthin/formats/bufr_header.h"
#include "libthin/formats/bufr_tables.h"
#include "libthin/foundation/result.h"

namespace thin {

// One element of a subset, or of all subsets where they are compressed.
struct BufrField {
  int descriptor = 0;  // as FXXYYY; 205YYY for characters in line; 0 for an associated field (204YYY)
  bool text = false;
  bool can_be_missing = true;     // all bits set mean missing
  bool in_quality_block = false;  // behind 222000 and its like: it tells about elements in front
  unsigned width = 0;             // bits of the value, or of the base where compressed
  std::size_t offset = 0;         // bits. Of the value from the subset's begin; compressed: of base from the data's
  unsigned increment_width = 0;   // compressed: bits that each subset has behind base and width; 0: the base alone
  std::int64_t reference = 0;
  double factor = 1;  // value = (number + reference) * factor
};

constexpr unsigned kIncrementWidthBits = 6;

// Subsets that are built alike: all of a compressed message; neighbours in one that is not.
struct AlikeSubsets {
  std::uint32_t first = 0;
  std::vector<BufrField> fields;
  std::vector<std::size_t> begins;  // not compressed: bits from the data's begin, one more than subsets
  std::uint32_t count = 0;
};

// Values of one field over subsets that are built alike; a constant is kept once.
class BufrColumn {
 public:
  BufrColumn() = default;
  explicit BufrColumn(std::vector<double> values) : values_(std::move(values)), stride_(values_.size() > 1 ? 1 : 0) {}

  bool is_constant() const { return stride_ == 0; }
  // NaN for missing. subset: from 0 among those that are alike.
  double operator[](std::size_t subset) const { return values_[stride_ * subset]; }

 private:
  std::vector<double> values_{std::numeric_limits<double>::quiet_NaN()};
  std::size_t stride_ = 0;
};

class BufrData {
 public:
  // Keeps a reference to the message's bytes, not to the tables. Error input, in a sentence about "it".
  static Result<BufrData> walk(std::span<const std::uint8_t> message, const BufrHeader& header,
                               const BufrTables& tables);

  bool compressed() const { return compressed_; }
  std::uint32_t subset_count() const { return subset_count_; }
  const std::vector<AlikeSubsets>& groups() const { return groups_; }
  std::span<const std::uint8_t> bytes() const { return data_; }

  // REQUIRES: a field of the group's, not text
  BufrColumn column(const AlikeSubsets& group, const BufrField& field) const;

  // REQUIRES: a field of the group's, text, not compressed; subset < group.count
  std::string text(const AlikeSubsets& group, const BufrField& field, std::size_t subset) const;

 private:
  std::span<const std::uint8_t> data_;  // section 4 without its first four bytes
  bool compressed_ = false;
  std::uint32_t subset_count_ = 0;
  std::vector<AlikeSubsets> groups_;
};

}  // namespace thin
