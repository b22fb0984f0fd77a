#pragma once

// The coefficients of a rectangle of which only some samples are known: few that are not zero, and right where the
// samples are known. Iterated thresholding: the unknown samples are what the coefficients so far make of them, carried
// on a little beyond, and the threshold falls from round to round (I. Daubechies, M. Defrise, C. De Mol, 2004; A. Beck,
// M. Teboulle, 2009).

#include <cstdint>
#include <vector>

#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

struct FitOptions {
  int rounds = 40;
  double first_threshold = 50;  // in steps, of the first round
  int further_rounds = 10;      // of a fit that begins where another one ended
  double further_threshold = 2;
  double last_threshold = 0.3;
  double momentum = 0.8;  // of the unknown samples: share of their last change that is added to the next
};

// Where a fit ended, for the next one of the same samples with other steps; empty before the first.
using FittedSamples = std::vector<double>;

// samples: rows x columns, not a number where unknown. support: the coefficients that may differ from 0 (the layout of
// wavelet_bands()); steps: the quantiser's step of each band. Where nothing is known, all are 0.
std::vector<double> fit_coefficients(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                     const std::vector<double>& samples, const std::vector<std::uint8_t>& support,
                                     const std::vector<Band>& bands, const std::vector<double>& steps,
                                     FittedSamples& fitted, const FitOptions& options = {});

}  // namespace emap
