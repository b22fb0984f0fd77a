#pragma once

// What the steps of the daemon's way say on standard output: one JSON object, with "outcome" and, where it is not the
// good one, "reason". The exit code says the same (docs/operations.md).

#include <nlohmann/json.hpp>
#include <string>

#include "libthin/foundation/result.h"
#include "libthin/tools/window_pipeline.h"

namespace thin {

using OutcomeJson = nlohmann::ordered_json;

void print_outcome(const OutcomeJson& outcome);

// Prints {"outcome": "unusable" | "incomplete" | "temporary" | "configuration" | "error", "reason": ...} and, for
// people, the reason on standard error. Returns the exit code.
int fail(const Error& error);

// The exit code of a command that people call; what is wrong goes to the log.
int finished(const Result<int>& code);

// The error of a file without the path in front, for those who know the file by another name: the daemon's spool, and
// reports, which must not depend on where the files lay.
Error without_path(Error error, const std::string& path);

OutcomeJson seconds_json(const StepSeconds& seconds);

}  // namespace thin
