#pragma once

#include <string>

#include "libthin/tools/window_pipeline.h"

namespace thin {

// report.json: what was done and why, the same bytes for the same input, configuration and version.
std::string report_json(const WindowOutcome& outcome, const Settings& settings);

// The outcome as a table for people: per satellite what came, was screened, was retained and how well it stands for the
// whole; then seconds per step.
std::string report_table(const WindowOutcome& outcome);

}  // namespace thin
