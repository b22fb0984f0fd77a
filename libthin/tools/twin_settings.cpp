#include "libthin/tools/twin_settings.h"

#include "libthin/tools/settings.h"

namespace thin {

Result<TwinSettings> read_twin_settings(const std::string& path) {
  Result<Configuration> configuration = Configuration::read(path);
  if (!configuration) return configuration.error();
  return read_twin_settings(std::move(*configuration));
}

Result<TwinSettings> read_twin_settings(Configuration configuration) {
  TwinSettings settings;
  const std::size_t variants = configuration.list_size("twin.variant");
  OptionTable twin, cycle, run;
  settings.twin.declare(twin);
  configuration.read_section("twin", twin);
  settings.variants = read_variants(configuration, "twin", variants, settings.twin.methods, std::nullopt);
  settings.cycle.declare(cycle);
  configuration.read_section("cycle", cycle);
  declare_run_options(run, settings.threads);
  configuration.read_section("run", run);
  ignore_other_sections(configuration);
  if (settings.twin.error_factors.empty() || settings.twin.counts.empty())
    configuration.add_problem("twin", "error_factors", "and counts must not be empty");
  if (Result<void> good = configuration.finish(); !good) return good.error();
  keep_resolved("twin", twin, settings.resolved);
  keep_resolved("cycle", cycle, settings.resolved);
  return settings;
}

}  // namespace thin
