#include "libthin/analysis/count_fitting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thin {
namespace {

// Between which limits the number retained is looked for.
struct DensityOption {
  const char* name;
  double least, largest;
};
constexpr DensityOption kDensityOptions[] = {{"horizontal_mesh", 1, 20000},
                                             {"min_horizontal_spacing", 1, 20000},
                                             {"step", 1, 1000},
                                             {"value_tolerance", 1e-3, 1e3}};
constexpr DensityOption kAnyOption = {"", 1e-3, 20000};
constexpr double kPrecision = 1.001;
constexpr double kMostSteps = 60;

}  // namespace

std::optional<std::string> density_option(const OptionTable& table) {
  for (const DensityOption& option : kDensityOptions)
    if (table.find(option.name)) return option.name;
  return std::nullopt;
}

Result<double> fit_to_count(const Thinner& thinner, const OptionTable& options, const std::string& name,
                            const ObservationSet& set, std::size_t count) {
  const Option* option = options.find(name);
  const bool is_integer = option && option->type == "integer";
  if (!option || (!is_integer && option->type != "number"))
    return Error{ErrorKind::configuration,
                 fmt::format("\"{}\" is no numeric option of {} that a number to retain can be fitted with", name,
                             thinner.method_name())};
  const auto assign = [&](double value) {
    return option->assign(is_integer ? OptionValue(static_cast<std::int64_t>(value)) : OptionValue(value));
  };
  const auto retained_with = [&](double value) -> Result<std::size_t> {
    if (const auto problem = assign(value))
      return Error{ErrorKind::configuration, fmt::format("{} {}", name, *problem)};
    const Result<Choice> choice = thinner.thin(set);
    if (!choice) return choice.error();
    return choice->retained.size();
  };

  // invariant: `dense` retains more than count, or is the least value; `sparse` does not
  const auto known = std::find_if(std::begin(kDensityOptions), std::end(kDensityOptions),
                                  [&](const DensityOption& each) { return each.name == name; });
  const DensityOption limits = known == std::end(kDensityOptions) ? kAnyOption : *known;
  double dense = std::max(limits.least, option->facts.minimum.value_or(limits.least));
  double sparse = std::min(limits.largest, option->facts.maximum.value_or(limits.largest));
  std::optional<double> best;
  std::size_t best_miss = 0;
  const auto try_value = [&](double value) -> Result<std::size_t> {
    Result<std::size_t> retained = retained_with(value);
    if (!retained) return retained;
    const std::size_t miss = std::max(*retained, count) - std::min(*retained, count);
    if (!best || miss < best_miss) best = value, best_miss = miss;
    return retained;
  };
  if (is_integer) {
    // Not by bisection: a pattern of observations may agree with one step better than with the one before.
    for (double value = std::ceil(dense); value <= std::min(sparse, dense + kMostSteps); ++value)
      if (const auto tried = try_value(value); !tried) return tried.error();
    sparse = dense;
  } else {
    for (const double end : {dense, sparse})
      if (const auto tried = try_value(end); !tried) return tried.error();
  }
  while (best_miss > 0 && sparse / dense > kPrecision) {
    const double middle = std::sqrt(dense * sparse);
    const auto retained = try_value(middle);
    if (!retained) return retained.error();
    (*retained > count ? dense : sparse) = middle;
  }
  if (const auto problem = assign(*best)) return Error{ErrorKind::internal, *problem};
  return *best;
}

}  // namespace thin
