#pragma once

#include <string>

#include "libthin/tools/window_pipeline.h"

namespace thin {

// The whole way of a window for people: each step with the options in force, what it left out, of which satellite and
// instrument, and why.
std::string explanation(const WindowOutcome& outcome, const Settings& settings);

}  // namespace thin
