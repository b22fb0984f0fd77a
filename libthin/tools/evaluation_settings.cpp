#include "libthin/tools/evaluation_settings.h"

#include <fmt/format.h>

#include "libthin/tools/settings.h"

namespace thin {
namespace {

constexpr const char* kSection = "evaluate";

}  // namespace

Result<EvaluationSettings> read_evaluation_settings(const std::string& path) {
  return read_settings_file(path, [](Configuration file) { return read_evaluation_settings(std::move(file)); });
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
  ignore_other_sections(configuration);
  if (Result<void> good = configuration.finish(); !good) return good.error();
  keep_resolved("evaluate", evaluation.without({"repetitions"}), settings.resolved);
  keep_resolved("synthetic", synthetic, settings.resolved);
  keep_resolved("input", input, settings.resolved);
  keep_resolved("preparation", preparation, settings.resolved);
  return settings;
}

}  // namespace thin
