#pragma once

// The coefficients of a rectangle of which only some samples are known: few that are not zero, and right where the
// samples are known. Iterated thresholding: the unknown samples are what the coefficients so far make of them, and the
// threshold falls from round to round (I. Daubechies, M. Defrise, C. De Mol, 2004; M. Elad and others, 2005).

#include <cstdint>
#include <vector>

#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

struct FitOptions {
  int rounds = 20;
  double first_threshold = 50;  // in steps, of the first round
  double last_threshold = 0.7;  // in steps
};

// samples: rows x columns, not a number where unknown. support: the coefficients that may differ from 0 (the layout of
// wavelet_bands()); steps: the quantiser's step of each band. Where nothing is known, all are 0.
std::vector<double> fit_coefficients(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                     const std::vector<double>& samples, const std::vector<std::uint8_t>& support,
                                     const std::vector<Band>& bands, const std::vector<double>& steps,
                                     const FitOptions& options = {});

}  // namespace emap
