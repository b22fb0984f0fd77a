#pragma once

// Masks at half the resolution of their maps. Sample (r, c) of the coarse mask is sample (2r, 2c) of the fine one; the
// others are in the mask where the canonical triangles of the coarse mask reach them: between two supported samples of
// a row or column, and in the middle of four of which three at least are supported. The fine surface covers the same
// area.

#include <cstdint>
#include <vector>

namespace emap {

// Rows or columns of the coarse mask of a map, and of the fine mask of a coarse one: n -> (n + 1) / 2 -> n or n - 1.
constexpr std::uint32_t halved(std::uint32_t n) {
  return (n + 1) / 2;
}
constexpr std::uint32_t doubled(std::uint32_t n) {
  return n == 0 ? 0 : 2 * n - 1;
}

std::vector<std::uint8_t> coarse_mask(std::uint32_t columns, std::uint32_t rows, const std::vector<std::uint8_t>& mask);

// columns, rows: of the coarse mask; the result has doubled() of both.
std::vector<std::uint8_t> refined_mask(std::uint32_t columns, std::uint32_t rows,
                                       const std::vector<std::uint8_t>& mask);

}  // namespace emap
