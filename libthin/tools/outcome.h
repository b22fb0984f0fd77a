#pragma once

// What the steps of the daemon's way say on standard output: one JSON object, with "outcome" and, where it is not the
// good one, "reason". The exit code says the same (docs/operations.md).

#include <nlohmann/json.hpp>

#include "libthin/foundation/result.h"
#include "libthin/tools/window_pipeline.h"

namespace thin {

using OutcomeJson = nlohmann::ordered_json;

void print_outcome(const OutcomeJson& outcome);

// Prints {"outcome": "unusable" | "incomplete" | "temporary" | "configuration" | "error", "reason": ...} and, for
// people, the reason on standard error. Returns the exit code.
int fail(const Error& error);

OutcomeJson seconds_json(const StepSeconds& seconds);

}  // namespace thin
