#pragma once

// The configuration of `thin evaluate`: [evaluate] with its [[evaluate.variant]]s, [synthetic], and [input],
// [preparation] and [run] as for `thin run`. Other sections are left to the other commands.

#include <string>
#include <vector>

#include "libthin/analysis/evaluation.h"
#include "libthin/analysis/synthetic_innovations.h"
#include "libthin/analysis/withholding.h"
#include "libthin/tools/settings.h"
#include "libthin/tools/variants.h"

namespace thin {

struct EvaluationSettings {
  EvaluationOptions evaluation;
  WithholdingOptions withholding;
  std::vector<Variant> variants;
  SyntheticOptions synthetic;
  InputOptions input;
  PreparationOptions preparation;
  int threads = 0;

  // Every option with the value in force, as "section.name", those of the variants not among them.
  std::vector<std::pair<std::string, std::string>> resolved;
};

// Error: configuration, with a line for every problem in the file.
Result<EvaluationSettings> read_evaluation_settings(const std::string& path);
Result<EvaluationSettings> read_evaluation_settings(Configuration configuration);

}  // namespace thin
