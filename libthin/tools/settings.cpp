#include "libthin/tools/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace thin {
void ignore_other_sections(Configuration& configuration) {
  for (const char* section : {"daemon", "window", "input", "preparation", "thinning", "output", "run", "evaluate",
                              "synthetic", "twin", "cycle"})
    configuration.ignore_section(section);
}

void keep_resolved(const std::string& section, const OptionTable& table, ResolvedOptions& resolved) {
  for (const Option& option : table.options())
    resolved.emplace_back(section + "." + option.name, option.current_value());
}

std::unique_ptr<Thinner> thinner_named(Configuration& configuration, const std::string& section, const std::string& key,
                                       const std::string& name) {
  if (const MethodEntry* entry = find_thinning_method(name)) return std::make_unique<Thinner>(*entry);
  std::vector<std::string> known;
  for (const MethodEntry& entry : thinning_methods()) known.push_back(entry.name);
  const auto meant = likely_meant(name, known);
  configuration.add_problem(section, key,
                            fmt::format("= \"{}\" is not a method; {}", name,
                                        meant ? fmt::format("did you mean \"{}\"?", *meant)
                                              : fmt::format("known are {}", fmt::join(known, ", "))));
  return nullptr;
}

std::unique_ptr<Thinner> thinner_named_in(Configuration& configuration, const std::string& section, std::string& name) {
  name = configuration.peek_text(section, "method").value_or(name);
  return thinner_named(configuration, section, "method", name);
}

void declare_run_options(OptionTable& table, int& threads) {
  table.add("threads", threads,
            {.minimum = 0, .maximum = 4096, .explanation = "for all parallel work; 0: as many as there are cores"});
}

Result<Settings> read_settings(const std::string& path) {
  return read_settings_file(path, [](Configuration file) { return read_settings(std::move(file)); });
}

Result<Settings> read_settings(Configuration configuration) {
  Settings settings;
  OptionTable input, thinning, preparation, output, run;
  settings.thinner = thinner_named_in(configuration, "thinning", settings.method_name);
  thinning.add("method", settings.method_name, {});
  if (settings.thinner) {
    settings.thinner->declare_options(thinning);
    configuration.read_section("thinning", thinning);
    if (const auto conflict = settings.thinner->conflict())
      configuration.add_problem("thinning", conflict->key, conflict->problem);
  }
  settings.input.declare(input);
  configuration.read_section("input", input);
  settings.preparation.declare(preparation);
  configuration.read_section("preparation", preparation);
  if (const auto conflict = settings.preparation.conflict())
    configuration.add_problem("preparation", conflict->key, conflict->problem);
  settings.output.declare(output);
  configuration.read_section("output", output);
  if (settings.thinner && settings.thinner->makes_observations() && settings.output.mode == OutputOptions::Mode::flag)
    configuration.add_problem(
        "output", "mode",
        fmt::format("= \"flag\" does not go with method = \"{}\", which makes observations of its own: there are none "
                    "to flag; its output is CF netCDF alone. Choose mode = \"subset\"",
                    settings.method_name));
  declare_run_options(run, settings.threads);
  configuration.read_section("run", run);
  ignore_other_sections(configuration);
  if (Result<void> good = configuration.finish(); !good) return good.error();
  keep_resolved("thinning", thinning, settings.resolved);
  keep_resolved("input", input, settings.resolved);
  keep_resolved("preparation", preparation, settings.resolved);
  keep_resolved("output", output, settings.resolved);
  return settings;
}

}  // namespace thin
