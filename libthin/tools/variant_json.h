#pragma once

// Variants in the JSON of whatever compares them.

#include <nlohmann/json.hpp>
#include <vector>

#include "libthin/analysis/evaluation.h"

namespace thin {

// Label, method, the option that is fitted, and every option with the value in force but for the number to retain.
nlohmann::ordered_json variant_json(const Variant& variant);

nlohmann::ordered_json failures_json(const std::vector<Evaluation::Failure>& failures,
                                     const std::vector<Variant>& variants);

}  // namespace thin
