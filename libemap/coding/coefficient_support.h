#pragma once

// Which coefficients of the rectangular wavelet matter to a mask: those whose function is large where the map is
// supported. The others are zero, and what they would say of the outside is of no interest.

#include <cstdint>
#include <vector>

#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

// Levels of the transform of a map: until the longer side of the low-pass band is at most four, at most eight.
std::uint32_t rectangular_levels(std::uint32_t columns, std::uint32_t rows);

// 1 for each coefficient that is coded, in the layout of wavelet_bands(). Level by level, a low-pass sample n of the
// next level matters where one of the samples 2n - 1 ... 2n + 1 does, a high-pass one where one of 2n ... 2n + 2 does,
// along rows and along columns. All of the coarsest low-pass band matters. Of the finest level no detail does.
std::vector<std::uint8_t> coefficient_support(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                              const std::vector<std::uint8_t>& mask);

// How much of a mask each coefficient sees, in the same layout: classes of the share of supported samples in the blocks
// of 2^level x 2^level samples around its middle. 0 none, 1 below a tenth, 2 a quarter, 3 a half, 4 three quarters, 5
// less than all, 6 all. What is hardly seen is seldom coded.
constexpr std::uint32_t kVisibilityClasses = 7;
std::vector<std::uint8_t> coefficient_visibility(std::uint32_t columns, std::uint32_t rows,
                                                 const std::vector<Band>& bands, const std::vector<std::uint8_t>& mask);

}  // namespace emap
