#pragma once

// Numbers of any width at any bit, most significant bit first, as section 4 of BUFR holds them.

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace thin {

constexpr unsigned kWidestNumber = 56;  // bits: with seven of shift it still fits into eight bytes

constexpr std::uint64_t all_ones(unsigned width) {
  return width == 0 ? 0 : ~std::uint64_t{0} >> (64 - width);
}

// REQUIRES: width <= kWidestNumber, and that many bits from `offset` on
inline std::uint64_t bits_at(std::span<const std::uint8_t> bytes, std::size_t offset, unsigned width) {
  assert(width <= kWidestNumber && offset + width <= 8 * bytes.size());
  const std::size_t first = offset / 8;
  const unsigned skipped = offset % 8;
  std::uint64_t word = 0;
  if (first + sizeof word <= bytes.size()) {
    std::memcpy(&word, bytes.data() + first, sizeof word);
    if constexpr (std::endian::native == std::endian::little) word = __builtin_bswap64(word);
  } else {
    for (std::size_t i = 0; i < sizeof word; ++i)
      word = word << 8 | (first + i < bytes.size() ? bytes[first + i] : std::uint8_t{0});
  }
  return width == 0 ? 0 : word << skipped >> (64 - width);
}

// Puts numbers behind one another.
class BitWriter {
 public:
  // REQUIRES: width <= kWidestNumber, value fits into it
  void put(std::uint64_t value, unsigned width) {
    assert(width <= kWidestNumber && (value & ~all_ones(width)) == 0);
    pending_ = pending_ << width | value;
    pending_width_ += width;
    while (pending_width_ >= 8) {
      pending_width_ -= 8;
      bytes_.push_back(static_cast<std::uint8_t>(pending_ >> pending_width_));
    }
  }

  // Copies `count` bits of `bytes` from `offset` on.
  void copy(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count) {
    constexpr unsigned kPiece = 48;
    for (; count > kPiece; offset += kPiece, count -= kPiece) put(bits_at(bytes, offset, kPiece), kPiece);
    put(bits_at(bytes, offset, static_cast<unsigned>(count)), static_cast<unsigned>(count));
  }

  // Everything so far, the last byte filled with zeros.
  std::vector<std::uint8_t> finish() {
    if (pending_width_ > 0) put(0, 8 - pending_width_);
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint64_t pending_ = 0;  // its lowest pending_width_ bits, fewer than 8, are not yet in bytes_
  unsigned pending_width_ = 0;
};

}  // namespace thin
