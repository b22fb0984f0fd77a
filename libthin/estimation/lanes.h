#pragma once

// Channels in groups of four doubles, which the compiler maps to whatever vector registers there are. Sums over
// channels are taken lane by lane and then across in a fixed order, so that the bits do not depend on the registers.

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

// Clones for AVX2 of the functions that profit, chosen when the program starts. Fused multiply-add stays off (see the
// top CMakeLists.txt). Sanitizers start too late for the choice.
#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define THIN_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define THIN_VECTOR_CLONES
#endif

namespace thin {

constexpr std::size_t kLaneCount = 4;

// Only ever a local variable: its alignment differs between the clones, so memory holds plain doubles.
using Lanes = double __attribute__((vector_size(kLaneCount * sizeof(double))));

inline __attribute__((always_inline)) Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline __attribute__((always_inline)) void store(const Lanes& lanes, double* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}
inline __attribute__((always_inline)) double across(const Lanes& x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}

// Channels of a row, rounded up to whole groups.
constexpr std::size_t padded(std::size_t channels) {
  return (channels + kLaneCount - 1) / kLaneCount * kLaneCount;
}

// rows x channels as rows x padded(channels), the rest filled with 0.
inline std::vector<double> pad_rows(std::span<const double> values, std::size_t channels) {
  const std::size_t rows = channels ? values.size() / channels : 0;
  std::vector<double> result(rows * padded(channels), 0.0);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t c = 0; c < channels; ++c) result[row * padded(channels) + c] = values[row * channels + c];
  return result;
}

}  // namespace thin
