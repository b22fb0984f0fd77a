#pragma once

#include <cstdint>
#include <random>

namespace emap::test {

// The Mersenne twister with numbers of the type that has 32 bits, not of the "fast" type that may have 64.
class Random32 {
 public:
  using result_type = std::uint32_t;
  explicit Random32(unsigned seed) : twister_(seed) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xFFFFFFFF; }
  result_type operator()() { return static_cast<result_type>(twister_()); }

 private:
  std::mt19937 twister_;
};

}  // namespace emap::test
