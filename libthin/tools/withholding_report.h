#pragma once

// A cross-validation as text: JSON with every draw's numbers, the same bytes each time, and a table for people.

#include <string>

#include "libthin/analysis/withholding.h"
#include "libthin/tools/evaluation_settings.h"

namespace thin {

std::string withholding_json(const Withholding& withholding, const EvaluationSettings& settings,
                             const ObservationSet& observations, const std::vector<std::string>& notes);

std::string withholding_table(const Withholding& withholding, const EvaluationSettings& settings,
                              const ObservationSet& observations);

}  // namespace thin
