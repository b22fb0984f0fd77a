#include "libthin/formats/bufr_data.h"

#include <algorithm>
#include <cassert>

#include "libthin/formats/bufr_bits.h"
#include "libthin/formats/bufr_walk.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kSection4Head = 4;  // three bytes of length, one reserved

bool alike(const std::vector<BufrField>& a, const std::vector<BufrField>& b) {
  const auto same = [](const BufrField& x, const BufrField& y) {
    return x.descriptor == y.descriptor && x.offset == y.offset && x.width == y.width && x.reference == y.reference;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

double value_of(const BufrField& field, std::uint64_t number) {
  return static_cast<double>(static_cast<std::int64_t>(number) + field.reference) * field.factor;
}

double number_or_missing(const BufrField& field, std::uint64_t bits) {
  if (field.can_be_missing && bits == all_ones(field.width)) return kMissing;
  return value_of(field, bits);
}

std::vector<double> compressed_values(std::span<const std::uint8_t> data, const BufrField& field, std::size_t count) {
  const std::uint64_t base = bits_at(data, field.offset, field.width);
  const unsigned width = field.increment_width;
  if (width == 0) return {number_or_missing(field, base)};
  const std::uint64_t missing = field.can_be_missing ? all_ones(width) : ~std::uint64_t{0};
  std::vector<double> values(count);
  std::size_t place = field.offset + field.width + kIncrementWidthBits;
  for (double& value : values) {
    const std::uint64_t increment = bits_at(data, place, width);
    value = increment == missing ? kMissing : value_of(field, base + increment);
    place += width;
  }
  return values;
}

// The subsets of an uncompressed message, one behind the other.
Result<std::vector<AlikeSubsets>> walk_subsets(BufrWalk& walk, const BufrHeader& header, std::size_t data_bits) {
  constexpr std::size_t kMostFields = 4'000'000;  // of subsets that are all built differently
  std::vector<AlikeSubsets> groups;
  std::size_t fields = 0;
  const auto count = static_cast<std::uint32_t>(header.subset_count);
  for (std::uint32_t subset = 0; subset < count; ++subset) {
    const std::size_t begin = subset == 0 ? 0 : walk.end();
    if (const Result<void> done = walk.subset(header.descriptors, begin); !done) return done.error();
    if (groups.empty() || !alike(groups.back().fields, walk.fields())) {
      fields += walk.fields().size();
      if (fields > kMostFields) return Error{ErrorKind::input, "its subsets are built in too many ways"};
      groups.push_back({.first = subset, .fields = std::move(walk.fields()), .begins = {begin}, .count = 0});
    }
    AlikeSubsets& group = groups.back();
    ++group.count;
    group.begins.push_back(walk.end());
    if (walk.depends_on_data()) continue;

    // All the others are built like the first.
    const std::size_t size = walk.end();
    if (size == 0 || size * count > data_bits)
      return Error{ErrorKind::input, "its data end before all of its subsets are there"};
    group.count = count;
    for (std::uint32_t other = 2; other <= count; ++other) group.begins.push_back(size * other);
    break;
  }
  return groups;
}

}  // namespace

Result<BufrData> BufrData::walk(std::span<const std::uint8_t> message, const BufrHeader& header,
                                const BufrTables& tables) {
  if (header.subset_count == 0) return Error{ErrorKind::input, "it has no subsets"};
  BufrData result;
  result.data_ = message.subspan(header.section4_offset + kSection4Head, header.section4_length - kSection4Head);
  result.compressed_ = header.compressed;
  result.subset_count_ = static_cast<std::uint32_t>(header.subset_count);
  // Constants are packed once for all subsets, but no two soundings have the same place: this bounds what a short file
  // can grow to.
  if (result.subset_count_ > 8 * result.data_.size())
    return Error{ErrorKind::input, "it has more subsets than bits of data"};
  BufrWalk walk({result.data_, &tables, header.compressed, result.subset_count_});
  if (!header.compressed) {
    auto groups = walk_subsets(walk, header, 8 * result.data_.size());
    if (!groups) return groups.error();
    result.groups_ = std::move(*groups);
    return result;
  }
  if (const Result<void> done = walk.subset(header.descriptors, 0); !done) return done.error();
  result.groups_.push_back(
      {.first = 0, .fields = std::move(walk.fields()), .begins = {}, .count = result.subset_count_});
  return result;
}

BufrColumn BufrData::column(const AlikeSubsets& group, const BufrField& field) const {
  assert(!field.text);
  if (compressed_) return BufrColumn(compressed_values(data_, field, group.count));
  std::vector<double> values(group.count);
  for (std::size_t subset = 0; subset < values.size(); ++subset)
    values[subset] = number_or_missing(field, bits_at(data_, group.begins[subset] + field.offset, field.width));
  return BufrColumn(std::move(values));
}

std::string BufrData::text(const AlikeSubsets& group, const BufrField& field, std::size_t subset) const {
  assert(field.text && !compressed_);
  std::string text;
  const std::size_t begin = group.begins[subset] + field.offset;
  for (std::size_t place = 0; place + 8 <= field.width; place += 8)
    text += static_cast<char>(bits_at(data_, begin + place, 8));
  return text;
}

}  // namespace thin
