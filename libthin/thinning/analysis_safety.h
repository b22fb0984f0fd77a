#pragma once

// Where analysis thinning is known to help less, or to hurt, and a configuration goes there: said in sentences.

#include <optional>
#include <string>
#include <vector>

#include "libthin/estimation/variogram.h"

namespace thin {

// What a run of the method is like.
struct AnalysisCircumstances {
  std::optional<Variogram> variogram;  // of the observations
  double correlation_length_km = 0;    // L in use
  bool length_is_given = false;
  double error_ratio = 0;
  bool ratio_is_given = false;
  double retained_per_square_length = 0;  // how many in an area of L²
  double gross_error_share = 0;           // of the observations
  bool values_are_innovations = true;
};

std::vector<std::string> analysis_warnings(const AnalysisCircumstances& circumstances);

}  // namespace thin
