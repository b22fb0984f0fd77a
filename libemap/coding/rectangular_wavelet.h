#pragma once

// The interpolating 13/7 wavelet by lifting on a whole rectangle: predict (-1, 9, 9, -1)/16, update (-1, 9, 9, -1)/32,
// with whole-sample symmetric extension (W. Sweldens, 1996). Coefficients lie as wavelet_bands() says. Where detail is
// zero, synthesis is the smooth interpolation of Deslauriers and Dubuc, so that a finest band that is never coded costs
// nothing.

#include <cstdint>
#include <vector>

#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

// In place; rows x columns, row by row.
void rectangular_analysis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                          std::vector<double>& samples);
void rectangular_synthesis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                           std::vector<double>& coefficients);

// The root of the sum of squares of what one coefficient 1 of such a band adds to the samples.
double synthesis_norm(const Band& band);

}  // namespace emap
