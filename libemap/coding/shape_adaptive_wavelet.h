#pragma once

// The shape-adaptive discrete wavelet transform with Daubechies' biorthogonal 9/7 filter, by lifting (S. Li, W. Li,
// 2000; I. Daubechies, W. Sweldens, 1998). As many coefficients as supported samples, whatever the shape. Each level
// transforms rows, then columns, of the low-pass quarter, every run of supported samples by itself with symmetric
// extension. Even positions become low-pass, odd ones high-pass; a run of one sample is low-pass wherever it lies. Low
// and high are scaled so that the transform is close to orthonormal: the squared error of coefficients is that of
// samples.

#include <cstdint>
#include <vector>

namespace emap {

// A rectangle of a transformed map: its coefficients of one kind. Level 1 is the finest.
struct Band {
  std::uint32_t row = 0, column = 0, rows = 0, columns = 0;
  std::uint32_t level = 0;
  std::uint32_t kind = 0;  // 0 low-pass (of the coarsest level), 1 high along rows, 2 high along columns, 3 both
};

// All bands of a map, coarsest first: low-pass, then kinds 1, 2, 3 of the coarsest level, and so on. Empty ones are
// left out.
std::vector<Band> wavelet_bands(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels);

// Levels for a map: until the shorter side would be less than about eight, at most six.
std::uint32_t wavelet_levels(std::uint32_t columns, std::uint32_t rows);

// The mask of the coefficients of a map with this mask; both rows x columns, row by row.
std::vector<std::uint8_t> shape_adaptive_support(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                                 std::vector<std::uint8_t> mask);

// In place. What lies outside the mask before, or outside its support after, is 0.
void shape_adaptive_analysis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                             const std::vector<std::uint8_t>& mask, std::vector<double>& samples);
void shape_adaptive_synthesis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                              const std::vector<std::uint8_t>& mask, std::vector<double>& coefficients);

}  // namespace emap
