// thin methods: every method and option, from the one place where they are declared.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "libthin/thinning/thinner.h"
#include "libthin/tools/commands.h"

namespace thin {
namespace {

using Json = nlohmann::ordered_json;

std::string limits_of(const OptionFacts& facts) {
  std::vector<std::string> limits;
  if (facts.above) limits.push_back(fmt::format("> {:g}", *facts.above));
  if (facts.minimum) limits.push_back(fmt::format(">= {:g}", *facts.minimum));
  if (facts.maximum) limits.push_back(fmt::format("<= {:g}", *facts.maximum));
  if (!facts.choices.empty()) limits.push_back(fmt::format("{}", fmt::join(facts.choices, " | ")));
  return fmt::format("{}", fmt::join(limits, ", "));
}

void print_method(const MethodEntry& entry) {
  Thinner thinner(entry);
  OptionTable table;
  thinner.declare_options(table);
  fmt::print("{}\n  {}\n  Source: {}\n", entry.name, entry.summary, entry.source);
  for (const Option& option : table.options()) {
    const std::string limits = limits_of(option.facts);
    fmt::print("    {:<24} {:<8} default {:<8}{}{}\n", option.name, option.type, option.default_value,
               option.facts.unit.empty() ? "" : "  unit: " + option.facts.unit,
               limits.empty() ? "" : "  (" + limits + ")");
    fmt::print("    {:<24} {}\n", "", option.facts.explanation);
  }
}

Json method_json(const MethodEntry& entry) {
  Thinner thinner(entry);
  OptionTable table;
  thinner.declare_options(table);
  Json json = {{"name", entry.name}, {"summary", entry.summary}, {"source", entry.source}, {"options", Json::array()}};
  for (const Option& option : table.options())
    json["options"].push_back({{"name", option.name},
                               {"type", option.type},
                               {"default", option.default_value},
                               {"unit", option.facts.unit},
                               {"limits", limits_of(option.facts)},
                               {"explanation", option.facts.explanation}});
  return json;
}

int show(const std::string& name, bool as_json) {
  const auto entries = thinning_methods();
  const MethodEntry* wanted = name.empty() ? nullptr : find_thinning_method(name);
  if (!name.empty() && !wanted) {
    std::vector<std::string> known;
    for (const MethodEntry& entry : entries) known.push_back(entry.name);
    fmt::print(stderr, "there is no method \"{}\"; known are {}\n", name, fmt::join(known, ", "));
    return exit_code(ErrorKind::configuration);
  }
  Json all = Json::array();
  for (const MethodEntry& entry : entries) {
    if (wanted && wanted != &entry) continue;
    if (as_json)
      all.push_back(method_json(entry));
    else
      print_method(entry);
  }
  if (as_json) fmt::print("{}\n", all.dump(2));
  return 0;
}

}  // namespace

void add_methods_command(CLI::App& program, Action& action) {
  struct Arguments {
    std::string name;
    bool as_json = false;
  };
  CLI::App* command = program.add_subcommand("methods", "every thinning method with its options, defaults and units");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("name", arguments->name, "this method alone");
  command->add_flag("--json", arguments->as_json, "for programs");
  command->callback(
      [arguments, &action] { action = [arguments] { return show(arguments->name, arguments->as_json); }; });
}

}  // namespace thin
