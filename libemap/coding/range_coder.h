#pragma once

// A binary arithmetic coder: 32-bit range, probabilities in 1/65536, bytes out, carries propagated (G. N. N. Martin's
// range coder). Three coders share one interface, bool code(bool bit, probability_of_one), so that one function
// describes a part of the stream for writing, for reading and for counting: the writer and the counter return the bit
// that they were given, the reader ignores it and returns the bit that it read.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace emap {

constexpr std::uint32_t kProbabilityBits = 16;
constexpr std::uint32_t kProbabilityOne = 1U << kProbabilityBits;

class RangeEncoder {
 public:
  // REQUIRES: 0 < probability_of_one < 65536
  bool code(bool bit, std::uint32_t probability_of_one) {
    const auto bound = static_cast<std::uint32_t>((std::uint64_t{range_} * probability_of_one) >> kProbabilityBits);
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    while (range_ < (1U << 24)) {
      range_ <<= 8;
      shift_low();
    }
    return bit;
  }

  // The fewest bytes from which a reader that sees zeros behind their end reads every bit back. Call once.
  std::vector<std::uint8_t> finish();

 private:
  void shift_low();

  std::uint64_t low_ = 0;  // invariant: < 2^33; bit 32 is a carry not yet handed to the bytes
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint8_t held_byte_ = 0;
  std::uint64_t held_count_ = 0;  // held_byte_ and the bytes 0xFF behind it that a carry may still change
  std::vector<std::uint8_t> bytes_;
};

class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> bytes);

  bool code(bool, std::uint32_t probability_of_one) {
    const auto bound = static_cast<std::uint32_t>((std::uint64_t{range_} * probability_of_one) >> kProbabilityBits);
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < (1U << 24)) {
      range_ <<= 8;
      code_ = (code_ << 8) | next_byte();
    }
    return bit;
  }

  // More was read than a whole stream can ask for: the stream was cut, or its bytes changed.
  bool exhausted() const { return bytes_past_end_ > kZerosBehindEnd; }
  // Of those given, about as many as the bits so far took.
  std::size_t bytes_read() const { return next_ < 4 ? 0 : next_ - 4; }

 private:
  // Behind the last byte that an encoder keeps it has dropped at most the four zeros of its state.
  static constexpr std::uint64_t kZerosBehindEnd = 4;

  std::uint32_t next_byte() {
    if (next_ < bytes_.size()) return bytes_[next_++];
    ++bytes_past_end_;
    return 0;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  std::uint64_t bytes_past_end_ = 0;
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint32_t code_ = 0;
};

// What a bit would cost, without writing it.
class BitCounter {
 public:
  bool code(bool bit, std::uint32_t probability_of_one) {
    bits_ += cost(bit ? probability_of_one : kProbabilityOne - probability_of_one);
    return bit;
  }
  double bits() const { return bits_; }

  // -log2(probability / 65536), to about a thousandth.
  static double cost(std::uint32_t probability) { return costs()[probability >> 4]; }

 private:
  static const std::array<float, 4096>& costs();
  double bits_ = 0;
};

}  // namespace emap
