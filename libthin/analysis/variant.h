#pragma once

// A method with its options, as one of several that are compared.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libthin/thinning/thinner.h"

namespace thin {

struct Variant {
  std::string label;  // different for each
  std::unique_ptr<Thinner> thinner;
  OptionTable options;  // of *thinner
  // For methods that can't be told a number: the option that is fitted to it; empty: run once, as it is.
  std::string fit;
};

// The numbers to ask of the variant: `counts`, each once, ascending; or one "nothing" for a variant that runs as it is.
std::vector<std::optional<std::int64_t>> numbers_for(const Variant& variant, const std::vector<int>& counts);

// Sets the variant's number, or fits its option to it, for these observations. The fitted value, where one was.
// Errors: as fit_to_count()
Result<std::optional<double>> aim_at(const Variant& variant, const ObservationSet& observations,
                                     std::optional<std::int64_t> asked);

// What goes on, of one variant or of a set to compare with: "farthest_point" (even), "random", any other: all.
// asked: how many. Errors: as aim_at() and Thinner::thin()
Result<Choice> choose_set(const Variant* variant, const std::string& label, const ObservationSet& observations,
                          std::optional<std::int64_t> asked, std::uint64_t seed);

}  // namespace thin
