#pragma once

// The configuration of `thin twin`: [twin] with its [[twin.variant]]s, [cycle], and [run]. Other sections are left to
// the other commands.

#include <string>
#include <utility>
#include <vector>

#include "libthin/analysis/twin_cycle.h"
#include "libthin/analysis/twin_experiment.h"
#include "libthin/tools/variants.h"

namespace thin {

struct TwinSettings {
  TwinOptions twin;
  TwinCycleOptions cycle;
  std::vector<Variant> variants;
  int threads = 0;
  std::vector<std::pair<std::string, std::string>> resolved;  // every option with the value in force
};

// Error: configuration, with a line for every problem in the file.
Result<TwinSettings> read_twin_settings(const std::string& path);
Result<TwinSettings> read_twin_settings(Configuration configuration);

}  // namespace thin
