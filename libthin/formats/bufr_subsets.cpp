#include "libthin/formats/bufr_subsets.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <string_view>

#include "libthin/formats/bufr_bits.h"

namespace thin {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::size_t increments_of(const BufrField& field) {
  return field.offset + field.width + kIncrementWidthBits;
}

// Base, width and increments as they came, without those of other subsets.
void copy_increments(Bytes data, const BufrField& field, std::span<const std::uint32_t> subsets, BitWriter& out) {
  out.copy(data, field.offset, field.width + kIncrementWidthBits);
  if (field.increment_width == 0) return;
  for (const std::uint32_t subset : subsets)
    out.copy(data, increments_of(field) + std::size_t{subset} * field.increment_width, field.increment_width);
}

// The element's numbers anew (regulation 94.6.3): base the smallest; all bits of an increment set for missing.
void pack_numbers(Bytes data, const BufrField& field, std::span<const std::uint32_t> subsets,
                  std::vector<std::uint64_t>& increments, BitWriter& out) {
  const std::uint64_t missing = all_ones(field.increment_width);
  std::uint64_t least = missing, most = 0;
  bool some_missing = false;
  increments.clear();
  for (const std::uint32_t subset : subsets) {
    const std::uint64_t increment =
        bits_at(data, increments_of(field) + std::size_t{subset} * field.increment_width, field.increment_width);
    increments.push_back(increment);
    if (increment == missing) {
      some_missing = true;
    } else {
      least = std::min(least, increment);
      most = std::max(most, increment);
    }
  }
  const bool all_missing = least == missing;
  const std::uint64_t base = all_missing ? all_ones(field.width) : bits_at(data, field.offset, field.width) + least;
  // A base that came out as all ones, or wider than its element, was no number to begin with: left as it is.
  if (!all_missing && base >= all_ones(field.width)) return copy_increments(data, field, subsets, out);

  const bool constant = all_missing || (!some_missing && least == most);
  const unsigned width = constant ? 0 : static_cast<unsigned>(std::bit_width(most - least + 1));
  out.put(base, field.width);
  out.put(width, kIncrementWidthBits);
  if (constant) return;
  for (const std::uint64_t increment : increments)
    out.put(increment == missing ? all_ones(width) : increment - least, width);
}

std::vector<std::uint8_t> compressed_data(const BufrData& data, std::span<const std::uint32_t> subsets) {
  BitWriter out;
  std::vector<std::uint64_t> increments;
  for (const BufrField& field : data.groups().front().fields) {
    // Where all bits set are no missing value, the width says what all bits are.
    if (field.text || !field.can_be_missing || field.increment_width == 0)
      copy_increments(data.bytes(), field, subsets, out);
    else
      pack_numbers(data.bytes(), field, subsets, increments, out);
  }
  return out.finish();
}

std::vector<std::uint8_t> uncompressed_data(const BufrData& data, std::span<const std::uint32_t> subsets) {
  BitWriter out;
  auto subset = subsets.begin();
  for (const AlikeSubsets& group : data.groups())
    for (; subset != subsets.end() && *subset < group.first + group.count; ++subset) {
      const std::size_t place = *subset - group.first;
      out.copy(data.bytes(), group.begins[place], group.begins[place + 1] - group.begins[place]);
    }
  return out.finish();
}

}  // namespace

std::vector<std::uint8_t> extract_subsets(std::span<const std::uint8_t> message, const BufrHeader& header,
                                          const BufrData& data, std::span<const std::uint32_t> subsets) {
  assert(!subsets.empty() && subsets.back() < data.subset_count());
  constexpr std::size_t kSection4Head = 4;
  constexpr std::string_view kEnd = "7777";
  std::vector<std::uint8_t> packed =
      data.compressed() ? compressed_data(data, subsets) : uncompressed_data(data, subsets);
  // Up to edition 3 sections have an even number of bytes.
  if (header.edition < 4 && packed.size() % 2 != 0) packed.push_back(0);

  const Bytes front = message.first(header.section4_offset + kSection4Head);
  std::vector<std::uint8_t> extracted(front.begin(), front.end());
  extracted.insert(extracted.end(), packed.begin(), packed.end());
  extracted.insert(extracted.end(), kEnd.begin(), kEnd.end());
  put_big_endian(extracted, 4, 3, static_cast<std::uint32_t>(extracted.size()));
  put_big_endian(extracted, header.section3_offset + 4, 2, static_cast<std::uint32_t>(subsets.size()));
  put_big_endian(extracted, header.section4_offset, 3, static_cast<std::uint32_t>(kSection4Head + packed.size()));
  return extracted;
}

}  // namespace thin
