#include "libthin/formats/bufr_walk.h"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "libthin/formats/bufr_bits.h"

namespace thin {
namespace {

constexpr int kCancel = 255;  // YYY of 203255
constexpr int kDataPresentClass = 31;

int f_of(int descriptor) {
  return descriptor / 100'000;
}
int x_of(int descriptor) {
  return descriptor / 1000 % 100;
}
int y_of(int descriptor) {
  return descriptor % 1000;
}

Error unreadable(const std::string& problem) {
  return {ErrorKind::input, problem};
}

// 10^-scale by repeated division or multiplication: the same roundings as ecCodes', so that values agree to the last
// bit.
double factor_of(int scale) {
  double factor = 1;
  for (; scale > 0; --scale) factor /= 10;
  for (; scale < 0; ++scale) factor *= 10;
  return factor;
}

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (; exponent > 0; --exponent) power *= 10;
  return power;
}

}  // namespace

Result<void> BufrWalk::subset(std::span<const int> list, std::size_t begin) {
  now_ = {};
  fields_.clear();
  begin_ = input_.compressed ? 0 : begin;
  place_ = begin;
  return descriptors(list, 0);
}

Result<void> BufrWalk::descriptors(std::span<const int> list, int depth) {
  if (depth > kDeepest) return unreadable("its sequences hold themselves");
  for (std::size_t place = 0; place < list.size(); ++place) {
    if (steps_left_-- == 0) return unreadable("its descriptors repeat without end");
    const int descriptor = list[place];
    Result<void> done;
    switch (f_of(descriptor)) {
      case 0:
        done = element(descriptor);
        break;
      case 1:
        done = replication(list, place, depth);
        break;
      case 2:
        done = operator_descriptor(descriptor);
        break;
      default: {
        const std::vector<int>* members = input_.tables->sequence(descriptor);
        if (!members)
          return unreadable(fmt::format("sequence {:06} is in no table that it names or brings", descriptor));
        done = descriptors(*members, depth + 1);
      }
    }
    if (!done) return done;
  }
  return {};
}

// 1XXYYY: the next XX descriptors, YYY times; where YYY is 0, as often as the data say.
Result<void> BufrWalk::replication(std::span<const int> list, std::size_t& place, int depth) {
  const auto replicated = static_cast<std::size_t>(x_of(list[place]));
  auto count = static_cast<std::size_t>(y_of(list[place]));
  std::size_t body = place + 1;
  if (count == 0) {
    if (body == list.size()) return unreadable("its descriptors repeat more descriptors than there are");
    const Result<std::size_t> factor = replication_factor(list[body]);
    if (!factor) return factor.error();
    count = *factor;
    ++body;
  }
  if (replicated == 0 || body + replicated > list.size())
    return unreadable("its descriptors repeat more descriptors than there are");
  for (std::size_t i = 0; i < count; ++i)
    if (const Result<void> done = descriptors(list.subspan(body, replicated), depth + 1); !done) return done;
  place = body + replicated - 1;
  return {};
}

Result<std::size_t> BufrWalk::replication_factor(int descriptor) {
  // 031011 and 031012 repeat data, too; no satellite data do.
  if (descriptor < 31000 || descriptor > 31002)
    return unreadable(fmt::format("{:06} stands where a replication's count should", descriptor));
  depends_on_data_ = true;
  if (const Result<void> done = element(descriptor); !done) return done.error();
  const BufrField& field = fields_.back();
  if (field.text) return unreadable("its tables have text for the count of a replication");
  const std::size_t value_place = begin_ + field.offset;
  const std::uint64_t count = bits_at(input_.data, value_place, field.width);
  if (field.increment_width > 0) {
    // Compressed subsets are alike by definition: increments, if there are any, must be the same.
    const std::size_t first = value_place + field.width + kIncrementWidthBits;
    const std::uint64_t increment = bits_at(input_.data, first, field.increment_width);
    for (std::size_t i = 1; i < input_.subset_count; ++i)
      if (bits_at(input_.data, first + i * field.increment_width, field.increment_width) != increment)
        return unreadable("its compressed subsets repeat descriptors differently often");
    return count + increment;
  }
  return count;
}

Result<void> BufrWalk::operator_descriptor(int descriptor) {
  const int y = y_of(descriptor);
  switch (x_of(descriptor)) {
    case 1:
      now_.added_width = y == 0 ? 0 : y - 128;
      return {};
    case 2:
      now_.added_scale = y == 0 ? 0 : y - 128;
      return {};
    case 3:
      if (y == 0) now_.references.clear();
      now_.reference_bits = y == kCancel ? 0 : static_cast<unsigned>(y);
      return {};
    case 4:
      if (y > 0)
        now_.associated.push_back(static_cast<unsigned>(y));
      else if (!now_.associated.empty())
        now_.associated.pop_back();
      return {};
    case 5:
      return add({.descriptor = descriptor, .text = true, .width = 8U * static_cast<unsigned>(y)});
    case 6:
      now_.local_width = static_cast<unsigned>(y);
      return {};
    case 7:
      now_.raised_by = y;
      return {};
    case 8:
      now_.characters = static_cast<unsigned>(y);
      return {};
    case 22:
    case 23:
    case 24:
    case 25:
    case 32:
      now_.in_quality_block = true;
      if (y == 0) return {};
      break;  // a value for an element that a bitmap points to
    case 35:
    case 36:
    case 37:
      return {};
    default:
      break;
  }
  return unreadable(fmt::format("it uses operator {}, which is not read", descriptor));
}

Result<void> BufrWalk::element(int descriptor) {
  const unsigned local_width = std::exchange(now_.local_width, 0U);
  const BufrElement* known = input_.tables->element(descriptor);
  if (now_.reference_bits > 0) return new_reference(descriptor);
  if (local_width > 0) {
    BufrElement described = known ? *known : BufrElement{};
    described.width = local_width;
    return described_element(descriptor, described);
  }
  if (!known) return unreadable(fmt::format("element {:06} is in no table that it names or brings", descriptor));
  return described_element(descriptor, *known);
}

// An element as the tables have it, and the operators in force.
Result<void> BufrWalk::described_element(int descriptor, const BufrElement& element) {
  const bool counts_replications = x_of(descriptor) == kDataPresentClass;
  if (!counts_replications)
    for (const unsigned width : now_.associated)
      if (const Result<void> done = add({.descriptor = 0, .can_be_missing = false, .width = width}); !done) return done;

  BufrField field{.descriptor = descriptor,
                  .text = element.kind == BufrElement::Kind::text,
                  .can_be_missing = !counts_replications,
                  .width = element.width,
                  .reference = element.reference};
  if (field.text && now_.characters > 0) field.width = 8 * now_.characters;
  if (field.text || counts_replications) return add(field);

  if (const auto changed = now_.references.find(descriptor); changed != now_.references.end())
    field.reference = changed->second;
  int scale = element.scale;
  if (element.kind == BufrElement::Kind::number) {
    constexpr int kHighestRaise = 9;
    constexpr std::int64_t kLargestReference = 100'000'000'000'000'000;
    if (now_.raised_by > kHighestRaise ||
        __builtin_mul_overflow(field.reference, power_of_ten(now_.raised_by), &field.reference) ||
        std::abs(field.reference) > kLargestReference)
      return unreadable(fmt::format("its operators make the reference of element {:06} too large", descriptor));
    const int width = static_cast<int>(element.width) + now_.added_width + (10 * now_.raised_by + 2) / 3;
    if (width <= 0) return unreadable(fmt::format("its operators leave no bits to element {:06}", descriptor));
    field.width = static_cast<unsigned>(width);
    scale += now_.added_scale + now_.raised_by;
  }
  constexpr int kLargestScale = 40;  // keeps every value finite
  if (std::abs(scale) > kLargestScale)
    return unreadable(fmt::format("element {:06} has the scale {}", descriptor, scale));
  field.factor = factor_of(scale);
  return add(field);
}

// Between 203YYY and 203255 elements stand for new references of YYY bits, the first of them the sign.
Result<void> BufrWalk::new_reference(int descriptor) {
  const unsigned width = now_.reference_bits;
  if (input_.compressed) return unreadable("its compressed data change references (203), which is not read");
  if (const Result<void> done = add({.descriptor = descriptor, .can_be_missing = false, .width = width}); !done)
    return done;
  depends_on_data_ = true;
  const std::uint64_t bits = bits_at(input_.data, begin_ + fields_.back().offset, width);
  const auto magnitude = static_cast<std::int64_t>(bits & all_ones(width - 1));
  now_.references[descriptor] = bits >> (width - 1) ? -magnitude : magnitude;
  return {};
}

// Passes over the field's bits, and keeps where they were.
Result<void> BufrWalk::add(BufrField field) {
  const std::size_t size = 8 * input_.data.size();
  const auto is_left = [&](std::size_t bits) { return bits <= size - place_; };
  if (field.width == 0 || (!field.text && field.width > kWidestNumber))
    return unreadable(fmt::format("element {:06} has {} bits", field.descriptor, field.width));
  if (fields_.size() == kMostFields) return unreadable("it has more elements in a subset than any sounding");
  const Error short_of_bits = {ErrorKind::input, "its data end before all of its elements are there"};
  field.in_quality_block = now_.in_quality_block;
  field.offset = place_ - begin_;
  if (!is_left(field.width)) return short_of_bits;
  place_ += field.width;
  if (input_.compressed) {
    if (!is_left(kIncrementWidthBits)) return short_of_bits;
    field.increment_width = static_cast<unsigned>(bits_at(input_.data, place_, kIncrementWidthBits));
    if (field.text) field.increment_width *= 8;  // characters
    if (!field.text && field.increment_width > kWidestNumber)
      return unreadable(
          fmt::format("increments of element {:06} have {} bits", field.descriptor, field.increment_width));
    place_ += kIncrementWidthBits;
    const std::size_t increments = std::size_t{field.increment_width} * input_.subset_count;
    if (!is_left(increments)) return short_of_bits;
    place_ += increments;
  }
  fields_.push_back(field);
  return {};
}

}  // namespace thin
