#pragma once

// What a thinning method is: options, and a choice of observations. Methods know nothing of files or reports.
//
// A new method is one .h/.cpp pair that derives from ThinningMethod, one line in registry.cpp, one case file in
// tests/cases, one line in tests/bench and one row in docs/methods.md.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// Indices of the retained observations, ascending.
using Retained = std::vector<std::uint32_t>;

class ThinningMethod {
 public:
  virtual ~ThinningMethod() = default;

  // Adds the method's options, with their defaults, to the table of its configuration section.
  virtual void declare_options(OptionTable& table) = 0;

  // What is wrong with the options taken together (each by itself is checked by the table): the key and the problem.
  struct Conflict {
    std::string key;
    std::string problem;
  };
  virtual std::optional<Conflict> conflict() const { return std::nullopt; }

  // Chooses. `observations` are in canonical order and free of missing values; ties go to the smaller index, so that
  // the choice depends neither on the order of the input nor on the number of threads. n = 0 and 1 are allowed.
  // Errors: input, where the method needs what these observations do not have; configuration, where they do not fit
  // together with the options. The message names the remedy.
  virtual Result<Retained> thin(const ObservationSet& observations) const = 0;

  // h of the Gaussian filter, for the methods that have one: the error report uses the same.
  virtual std::optional<double> bandwidth_km() const { return std::nullopt; }
};

struct MethodEntry {
  std::string name;  // as in the configuration
  std::string summary;
  std::string source;  // equation or paper
  std::unique_ptr<ThinningMethod> (*make)();
};

// All methods, by name.
std::span<const MethodEntry> thinning_methods();

// The entry of that name, or nothing.
const MethodEntry* find_thinning_method(const std::string& name);

// Error: configuration, if a value is not finite. Methods call this first; NaN would spread through every sum.
Result<void> require_finite_values(const ObservationSet& observations);

}  // namespace thin
