#pragma once

#include <string>

#include "libthin/foundation/options.h"

namespace thin {

// "> 0, <= 5000", "full | lazy"; empty where there are none.
std::string limits_text(const OptionFacts& facts);

// Two lines for each option: name, type, default, unit and limits; then the explanation.
std::string options_text(const OptionTable& table);

}  // namespace thin
