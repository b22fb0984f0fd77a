#include "libemap/coding/range_coder.h"

#include <cmath>

namespace emap {

void RangeEncoder::shift_low() {
  // A byte below 0xFF, or a carry, settles all bytes that were held back. Nothing carries into the first one.
  if (held_count_ == 0 || low_ < 0xFF000000U || low_ > 0xFFFFFFFFU) {
    const auto carry = static_cast<std::uint8_t>(low_ >> 32);
    if (held_count_ > 0) bytes_.push_back(static_cast<std::uint8_t>(held_byte_ + carry));
    for (; held_count_ > 1; --held_count_) bytes_.push_back(static_cast<std::uint8_t>(0xFF + carry));
    held_count_ = 0;
    held_byte_ = static_cast<std::uint8_t>(low_ >> 24);
  }
  ++held_count_;
  low_ = (low_ & 0x00FFFFFFU) << 8;
}

std::vector<std::uint8_t> RangeEncoder::finish() {
  // The number in [low, low + range) with the most zeros at its end.
  const std::uint64_t end = low_ + range_;
  for (int zeros = 32; zeros >= 0; --zeros) {
    const std::uint64_t step = std::uint64_t{1} << zeros;
    const std::uint64_t candidate = (low_ + step - 1) & ~(step - 1);
    if (candidate < end) {
      low_ = candidate;
      break;
    }
  }
  for (int i = 0; i < 5; ++i) shift_low();
  for (int dropped = 0; dropped < 4 && !bytes_.empty() && bytes_.back() == 0; ++dropped) bytes_.pop_back();
  return std::move(bytes_);
}

RangeDecoder::RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | next_byte();
}

const std::array<float, 4096>& BitCounter::costs() {
  static const std::array<float, 4096> table = [] {
    std::array<float, 4096> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<float>(-std::log2((static_cast<double>(i) + 0.5) / 4096.0));
    return values;
  }();
  return table;
}

}  // namespace emap
