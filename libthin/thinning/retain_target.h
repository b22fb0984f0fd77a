#pragma once

// How many to retain, for the methods that can be stopped at any number.

#include <optional>

#include "libthin/thinning/thinning_method.h"

namespace thin {

struct RetainTarget {
  std::optional<std::int64_t> retain_count;
  std::optional<double> retain_fraction;

  void declare_options(OptionTable& table);

  // Both, or neither.
  std::optional<ThinningMethod::Conflict> conflict() const;

  // The number out of n: never more than n; a fraction is rounded to the nearest, but keeps at least one of any.
  std::size_t count_of(std::size_t n) const;
};

}  // namespace thin
