#include "libthin/preparation/screening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thin {
namespace {

// The column of a variable; empty where the set lacks it.
using Column = std::span<const double>;

Column column_of(const ObservationSet& set, const std::string& variable) {
  const auto found = set.variables.find(variable);
  return found == set.variables.end() ? Column() : Column(found->second);
}

bool is_flagged(double value, const FlagRule& rule) {
  if (std::isnan(value)) return false;
  if (!rule.mask) return value != 0;
  constexpr double kTooLarge = 18446744073709551616.0;  // 2^64
  return value >= 0 && value < kTooLarge && (static_cast<std::uint64_t>(value) & *rule.mask) != 0;
}

bool is_at_edge(const ObservationSet& set, std::size_t i, const ScreeningOptions& options) {
  const int position = set.field_of_view[i];
  const int positions = fields_of_view_per_line(set.instrument[i]);
  const int skipped = options.skipped_edge_of(set.instrument[i]);
  if (position == kUnknownNumber || positions == 0) return false;
  return position <= skipped || position > positions - skipped;
}

// Everything but the rules and the channels.
ScreeningReason selection(const ObservationSet& set, std::size_t i, const ScreeningOptions& options) {
  if (!options.platforms.empty() && !options.platforms.contains(set.platform[i])) return ScreeningReason::platform;
  if (!options.instruments.empty() && !options.instruments.contains(set.instrument[i]))
    return ScreeningReason::instrument;
  if (set.latitude_deg[i] < options.minimum_latitude_deg || set.latitude_deg[i] > options.maximum_latitude_deg)
    return ScreeningReason::latitude;
  if (is_at_edge(set, i, options)) return ScreeningReason::scan_position;
  if (!options.surfaces.empty() && !options.surfaces.contains(set.surface[i]))
    return set.surface[i] == Surface::unknown ? ScreeningReason::unknown_surface : ScreeningReason::surface;
  return ScreeningReason::none;
}

ScreeningReason rule_reason(std::size_t rule) {
  return static_cast<ScreeningReason>(static_cast<std::size_t>(ScreeningReason::first_rule) + rule);
}

void apply_rules(const ObservationSet& set, const ScreeningOptions& options, Screening& screening) {
  std::size_t number = 0;
  const auto apply = [&](const std::string& variable, const auto& is_rejected) {
    const Column column = column_of(set, variable);
    if (column.empty() && set.size() > 0) screening.absent.push_back(variable);
    for (std::size_t i = 0; i < set.size(); ++i)
      if (screening.reasons[i] == ScreeningReason::none && is_rejected(column.empty() ? std::nan("") : column[i]))
        screening.reasons[i] = rule_reason(number);
    ++number;
  };
  for (const FlagRule& rule : options.flags)
    apply(rule.variable, [&](double value) { return is_flagged(value, rule); });
  for (const VariableRule& rule : options.variables)
    apply(rule.variable, [&](double value) { return !(value >= rule.minimum && value <= rule.maximum); });
}

ScreeningReason judge_channels(const ObservationSet& set, std::size_t i, const std::vector<std::size_t>& places,
                               const ScreeningOptions& options) {
  const GrossLimits limits = options.limits_of(set.instrument[i]);
  const auto values = set.values_of(i);
  bool measures_any = false;
  for (const std::size_t place : places) {
    if (!set.measures(i, place)) continue;
    measures_any = true;
    switch (value_state(values[place], set.value_kind, limits)) {
      case ValueState::missing:
        return ScreeningReason::missing_value;
      case ValueState::outside:
        return ScreeningReason::outside_limits;
      case ValueState::good:
        break;
    }
  }
  return measures_any ? ScreeningReason::none : ScreeningReason::no_live_channel;
}

std::string name_of_rule(std::size_t rule, const ScreeningOptions& options) {
  if (rule < options.flags.size()) {
    const FlagRule& flag = options.flags[rule];
    return flag.mask ? fmt::format("{} has bits of {:#x}", flag.variable, *flag.mask) : flag.variable + " is not 0";
  }
  const VariableRule& limits = options.variables.at(rule - options.flags.size());
  return fmt::format("{} missing or outside {:g} to {:g}", limits.variable, limits.minimum, limits.maximum);
}

}  // namespace

std::string name_of(ScreeningReason reason, const ScreeningOptions& options) {
  switch (reason) {
    case ScreeningReason::none:
      return "none";
    case ScreeningReason::platform:
      return "satellite not among platforms";
    case ScreeningReason::instrument:
      return "instrument not among instruments";
    case ScreeningReason::latitude:
      return "outside the latitude band";
    case ScreeningReason::scan_position:
      return "scan position at the edge";
    case ScreeningReason::surface:
      return "surface not asked for";
    case ScreeningReason::unknown_surface:
      return "surface unknown";
    case ScreeningReason::no_live_channel:
      return "no channel of the instrument is alive on every satellite";
    case ScreeningReason::missing_value:
      return "missing value in a used channel";
    case ScreeningReason::outside_limits:
      return "temperature outside the gross limits";
    case ScreeningReason::no_bias_correction:
      return "no bias correction";
    case ScreeningReason::no_first_guess:
      return "no first guess in the file";
    case ScreeningReason::no_companion:
      return "no first guess in the companion files";
    case ScreeningReason::first_rule:
      break;
  }
  return name_of_rule(static_cast<std::size_t>(reason) - static_cast<std::size_t>(ScreeningReason::first_rule),
                      options);
}

Result<Screening> screen(const ObservationSet& set, const ScreeningOptions& options) {
  Screening screening;
  screening.reasons.resize(set.size(), ScreeningReason::none);
  for (std::size_t i = 0; i < set.size(); ++i) screening.reasons[i] = selection(set, i, options);
  apply_rules(set, options, screening);

  std::vector<std::uint32_t> selected;
  for (std::uint32_t i = 0; i < set.size(); ++i)
    if (screening.reasons[i] == ScreeningReason::none) selected.push_back(i);
  Result<ChannelChoice> choice = choose_channels(set, selected, options);
  if (!choice) return choice.error();
  screening.channel_places = std::move(choice->places);
  screening.dead = std::move(choice->dead);
  for (const std::uint32_t i : selected)
    screening.reasons[i] = judge_channels(set, i, screening.channel_places, options);
  return screening;
}

}  // namespace thin
