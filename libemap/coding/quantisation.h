#pragma once

// The uniform quantiser of coder 2 (docs/emap-format.md, "Coder 2", elevations): what a whole number stands for.

#include <cmath>
#include <cstdint>
#include <vector>

#include "libemap/coding/rectangular_wavelet.h"
#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

// Quantised coefficients are below 2^kValueBits.
constexpr std::uint32_t kValueBits = 26;

struct QuantisedMap {
  std::uint32_t columns = 0, rows = 0;
  std::vector<Band> bands;
  std::vector<std::uint8_t> support;     // 1 for the coefficients that are coded
  std::vector<std::uint8_t> visibility;  // coefficient_visibility()
  std::vector<std::int32_t> values;      // 0 outside the support

  std::size_t index(std::uint32_t row, std::uint32_t column) const { return std::size_t{row} * columns + column; }
};

// Of a map with this mask, all values 0.
QuantisedMap quantised_map(std::uint32_t columns, std::uint32_t rows, const std::vector<std::uint8_t>& mask);

// An error of half a step in every coefficient is one of half a step in every coarse sample, root mean square: four
// fine samples stand for a coarse one.
inline double step_of_band(const Band& band, double step) {
  return 2 * step / synthesis_norm(band);
}

// Where a reader puts a coefficient within its interval, in steps of the band.
inline double reconstructed(std::int32_t value, std::uint32_t kind) {
  constexpr double kOffset = 0.03;
  if (value == 0 || kind == 0) return value;
  return value < 0 ? value - kOffset : value + kOffset;
}

template <class Function>
void for_band(const Band& band, std::uint32_t columns, const Function& function) {
  for (std::uint32_t r = band.row; r < band.row + band.rows; ++r)
    for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) function(std::size_t{r} * columns + c);
}

}  // namespace emap
