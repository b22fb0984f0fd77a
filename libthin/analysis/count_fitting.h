#pragma once

// Methods that can't be told how many to retain have an option instead that sets the density: the side of a box, a
// spacing, a step, a tolerance. To compare them at equal numbers, it is fitted.

#include <optional>
#include <string>

#include "libthin/thinning/thinner.h"

namespace thin {

// The option of `table` that sets the density: the first of horizontal_mesh, min_horizontal_spacing, step and
// value_tolerance that it has. Nothing, where it has none.
std::optional<std::string> density_option(const OptionTable& table);

// Sets the numeric option so that the number retained comes nearest to `count`: by bisection to 1 in 1,000, for fewer
// are retained the larger the option is; of integers the 60 least are tried one by one. `options` are those of
// `thinner`. Returns the value.
// Errors: those of Thinner::thin; configuration, where there is no such option, or it is no number.
Result<double> fit_to_count(const Thinner& thinner, const OptionTable& options, const std::string& name,
                            const ObservationSet& observations, std::size_t count);

}  // namespace thin
