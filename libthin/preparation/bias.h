#pragma once

// Bias correction of temperatures: value minus the bias of the table minus the sum of coefficient times predictor.

#include <optional>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"
#include "libthin/preparation/bias_table.h"

namespace thin {

struct BiasOptions {
  enum class Uncorrected { screen, keep };
  std::string table;       // file; empty: none
  std::string predictors;  // file; empty: none
  Uncorrected uncorrected = Uncorrected::screen;

  bool any() const { return !table.empty() || !predictors.empty(); }
  void declare(OptionTable& table);
};

struct BiasCounts {
  std::size_t corrected = 0;
  std::size_t uncorrected = 0;  // at least one channel without table entry or predictor
};

// Corrects the values that are there, in place. An observation of which one value lacks a correction stays as it was,
// whole, and is true in `uncorrected` (n); so do innovations and, with `skip`, the observations named there (n), which
// are not counted. table, predictors: nullptr for none; where both are there, both are needed.
BiasCounts correct_bias(ObservationSet& observations, const BiasTable* table, const BiasPredictors* predictors,
                        const std::vector<bool>& skip, std::vector<bool>& uncorrected);

}  // namespace thin
