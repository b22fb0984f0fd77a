#pragma once

// An evaluation as text. JSON and CSV hold what depends on the observations and the configuration alone, the same bytes
// each time; seconds and memory stand apart.

#include <string>

#include "libthin/analysis/evaluation.h"
#include "libthin/tools/evaluation_settings.h"

namespace thin {

// Observations, options, variants, results; boxes and retained sets where they were asked for.
std::string evaluation_json(const Evaluation& evaluation, const EvaluationSettings& settings,
                            const ObservationSet& observations, const std::vector<std::string>& notes);

// One line for each result: variant, numbers, errors, signal-to-noise ratios, separations, shares.
std::string evaluation_csv(const Evaluation& evaluation, const EvaluationSettings& settings);

// One line for each result: seconds (median, least, most of the repetitions), processor seconds, peak memory.
std::string costs_csv(const Evaluation& evaluation, const std::vector<Variant>& variants);

// The most important of it all, for people.
std::string evaluation_table(const Evaluation& evaluation, const EvaluationSettings& settings);

}  // namespace thin
