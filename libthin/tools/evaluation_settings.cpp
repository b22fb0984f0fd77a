#include "libthin/tools/evaluation_settings.h"

#include <fmt/format.h>

#include <filesystem>

#include "libthin/tools/preparation_data.h"

namespace thin {
namespace {

constexpr const char* kSection = "evaluate";

void keep_resolved(const std::string& section, const OptionTable& table, EvaluationSettings& settings) {
  for (const Option& option : table.options())
    settings.resolved.emplace_back(section + "." + option.name, option.current_value());
}

}  // namespace

Result<EvaluationSettings> read_evaluation_settings(const std::string& path) {
  Result<Configuration> configuration = Configuration::read(path);
  if (!configuration) return configuration.error();
  Result<EvaluationSettings> settings = read_evaluation_settings(std::move(*configuration));
  std::error_code ignored;
  const std::filesystem::path absolute = std::filesystem::absolute(path, ignored);
  if (settings) make_paths_absolute(settings->preparation, absolute.parent_path().string());
  return settings;
}

Result<EvaluationSettings> read_evaluation_settings(Configuration configuration) {
  EvaluationSettings settings;
  const std::size_t variants = configuration.list_size(fmt::format("{}.variant", kSection));
  OptionTable evaluation, synthetic, input, preparation, run;
  settings.evaluation.declare(evaluation);
  settings.withholding.declare(evaluation);
  configuration.read_section(kSection, evaluation);
  settings.variants =
      read_variants(configuration, kSection, variants, settings.evaluation.methods, settings.evaluation.bandwidth_km);
  settings.synthetic.declare(synthetic);
  configuration.read_section("synthetic", synthetic);
  settings.input.declare(input);
  configuration.read_section("input", input);
  settings.preparation.declare(preparation);
  configuration.read_section("preparation", preparation);
  if (const auto conflict = settings.preparation.conflict())
    configuration.add_problem("preparation", conflict->key, conflict->problem);
  declare_run_options(run, settings.threads);
  configuration.read_section("run", run);
  for (const char* section : {"thinning", "output", "daemon", "window", "twin", "cycle"})
    configuration.ignore_section(section);
  if (Result<void> good = configuration.finish(); !good) return good.error();
  keep_resolved("evaluate", evaluation.without({"repetitions"}), settings);
  keep_resolved("synthetic", synthetic, settings);
  keep_resolved("input", input, settings);
  keep_resolved("preparation", preparation, settings);
  return settings;
}

}  // namespace thin
