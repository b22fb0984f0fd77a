#include "libthin/tools/option_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thin {

std::string limits_text(const OptionFacts& facts) {
  std::vector<std::string> limits;
  if (facts.above) limits.push_back(fmt::format("> {:g}", *facts.above));
  if (facts.minimum) limits.push_back(fmt::format(">= {:g}", *facts.minimum));
  if (facts.maximum) limits.push_back(fmt::format("<= {:g}", *facts.maximum));
  if (!facts.choices.empty()) limits.push_back(fmt::format("{}", fmt::join(facts.choices, " | ")));
  return fmt::format("{}", fmt::join(limits, ", "));
}

std::string options_text(const OptionTable& table) {
  std::string text;
  for (const Option& option : table.options()) {
    const std::string limits = limits_text(option.facts);
    text += fmt::format("    {:<24} {:<8} default {:<8}{}{}\n", option.name, option.type, option.default_value,
                        option.facts.unit.empty() ? "" : "  unit: " + option.facts.unit,
                        limits.empty() ? "" : "  (" + limits + ")");
    text += fmt::format("    {:<24} {}\n", "", option.facts.explanation);
  }
  return text;
}

}  // namespace thin
