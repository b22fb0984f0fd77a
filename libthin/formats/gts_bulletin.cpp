#include "libthin/formats/gts_bulletin.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <regex>
#include <string>
#include <string_view>

namespace thin {
namespace {

constexpr std::uint8_t kStartOfHeading = 0x01;
constexpr std::uint8_t kEndOfText = 0x03;
constexpr std::size_t kLongestHeading = 80;

bool is_digit(std::uint8_t byte) {
  return byte >= '0' && byte <= '9';
}

// What all_of needs from the front: how many bytes are digits.
std::size_t leading_digits(std::span<const std::uint8_t> bytes) {
  return static_cast<std::size_t>(std::find_if_not(bytes.begin(), bytes.end(), is_digit) - bytes.begin());
}

}  // namespace

GtsHeading find_gts_heading(std::span<const std::uint8_t> before) {
  static const std::regex kHeading(
      "((\\d{8}0[01])?(\x01?\r{0,2}\n(\\d{3,5}\r{0,2}\n)?)?)"  // prefix, start, sequence number
      "[A-Z]{4}\\d{0,2} [A-Z0-9]{4} \\d{6}( [A-Z]{3})?\r{0,2}\n$",
      std::regex::ECMAScript | std::regex::optimize);
  if (before.empty() || before.back() != '\n') return {};
  const auto window = before.last(std::min(before.size(), kLongestHeading));
  const std::string text(window.begin(), window.end());
  std::smatch match;
  if (!std::regex_search(text, match, kHeading)) return {};
  std::size_t size = static_cast<std::size_t>(match.length(0));
  // The line end in front of a bare heading line belongs to whatever stands before it.
  const bool bare = !match[2].matched && match[3].length() > 0 && text[match.position(3)] != kStartOfHeading;
  if (bare) size -= static_cast<std::size_t>(match.length(3));
  return {size, match[2].matched};
}

std::size_t gts_trailer_size(std::span<const std::uint8_t> after) {
  std::size_t place = 0;
  while (place < after.size() && place < 2 && after[place] == '\r') ++place;
  if (place < after.size() && after[place] == '\n') ++place;
  return place < after.size() && after[place] == kEndOfText ? place + 1 : 0;
}

bool is_gts_end_marker(std::span<const std::uint8_t> rest) {
  return rest.size() >= kGtsLengthPrefixSize &&
         std::all_of(rest.begin(), rest.begin() + 9, [](std::uint8_t byte) { return byte == '0'; }) &&
         (rest[9] == '0' || rest[9] == '1');
}

bool is_cut_gts_heading(std::span<const std::uint8_t> rest) {
  const std::string_view tail(reinterpret_cast<const char*>(rest.data()), rest.size());
  if (tail == "B" || tail.ends_with("BU") || tail.ends_with("BUF")) return true;
  if (rest.empty() || rest.size() > kLongestHeading || is_gts_end_marker(rest)) return false;
  const std::size_t digits = leading_digits(rest);
  if (digits == rest.size() && digits <= kGtsLengthPrefixSize) return true;
  if (digits == kGtsLengthPrefixSize) return rest[digits] == kStartOfHeading || rest[digits] == '\r';
  return rest[0] == kStartOfHeading;
}

void put_gts_length(std::span<std::uint8_t> bulletin) {
  assert(bulletin.size() >= kGtsLengthPrefixSize);
  char digits[24];
  std::snprintf(digits, sizeof digits, "%08zu", bulletin.size() - kGtsLengthPrefixSize);
  std::copy_n(digits, 8, bulletin.begin());
}

}  // namespace thin
