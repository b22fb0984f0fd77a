#include "libthin/tools/evaluation_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "libthin/analysis/count_fitting.h"
#include "libthin/tools/preparation_data.h"

namespace thin {
namespace {

constexpr const char* kSection = "evaluate";
constexpr const char* kVariants = "evaluate.variant";

// A variant of the method with its defaults, but for the bandwidth: the common one.
Variant variant_of(std::unique_ptr<Thinner> thinner, std::optional<double> bandwidth_km) {
  Variant variant;
  variant.thinner = std::move(thinner);
  variant.thinner->declare_options(variant.options);
  // Any number; each point of the curve has its own.
  if (variant.thinner->stops_at_count()) variant.thinner->set_retain_count(1);
  const Option* bandwidth = variant.options.find("bandwidth_km");
  if (bandwidth && bandwidth_km) bandwidth->assign(*bandwidth_km);
  return variant;
}

std::string fitted_option(const Variant& variant, const std::string& fit) {
  if (variant.thinner->stops_at_count() || fit == "none") return "";
  return fit == "auto" ? density_option(variant.options).value_or("") : fit;
}

void read_variant(Configuration& configuration, const std::string& section, EvaluationSettings& settings) {
  VariantKeys keys;
  std::unique_ptr<Thinner> thinner = thinner_named_in(configuration, section, keys.method);
  if (!thinner) return;
  const bool has_rule = configuration.peek_text(section, "bandwidth").value_or("fixed") != "fixed";
  Variant variant =
      variant_of(std::move(thinner), has_rule ? std::nullopt : std::optional(settings.evaluation.bandwidth_km));
  OptionTable table = variant.options.without({"retain_count", "retain_fraction"});
  keys.declare(table);
  configuration.read_section(section, table);
  variant.label = keys.label.empty() ? keys.method : keys.label;
  variant.fit = fitted_option(variant, keys.fit);
  if (!variant.fit.empty() && !variant.options.find(variant.fit))
    configuration.add_problem(section, "fit", fmt::format("= \"{}\" is no option of {}", keys.fit, keys.method));
  if (const auto conflict = variant.thinner->conflict())
    configuration.add_problem(section, conflict->key, conflict->problem);
  settings.variants.push_back(std::move(variant));
}

void add_methods(Configuration& configuration, EvaluationSettings& settings) {
  std::vector<std::string> names = settings.evaluation.methods;
  if (names.empty() && settings.variants.empty())
    for (const MethodEntry& entry : thinning_methods()) names.push_back(entry.name);
  for (const std::string& name : names) {
    std::unique_ptr<Thinner> thinner = thinner_named(configuration, kSection, "methods", name);
    if (!thinner) continue;
    Variant variant = variant_of(std::move(thinner), settings.evaluation.bandwidth_km);
    variant.label = name;
    variant.fit = fitted_option(variant, "auto");
    settings.variants.push_back(std::move(variant));
  }
}

void require_different_labels(Configuration& configuration, const std::vector<Variant>& variants) {
  std::vector<std::string> labels;
  for (const Variant& variant : variants) labels.push_back(variant.label);
  std::sort(labels.begin(), labels.end());
  for (auto twice = std::adjacent_find(labels.begin(), labels.end()); twice != labels.end();
       twice = std::adjacent_find(std::upper_bound(twice, labels.end(), *twice), labels.end()))
    configuration.add_problem(
        kSection, "methods",
        fmt::format("and [[{}]] give two variants the label \"{}\"; set label", kVariants, *twice));
}

void keep_resolved(const std::string& section, const OptionTable& table, EvaluationSettings& settings) {
  for (const Option& option : table.options())
    settings.resolved.emplace_back(section + "." + option.name, option.current_value());
}

}  // namespace

void VariantKeys::declare(OptionTable& table) {
  table.add("method", method, {.explanation = "as in [thinning]; every option of the method may follow"});
  table.add("label", label, {.explanation = "its name in tables and files; empty: the method's"});
  table.add(
      "fit", fit,
      {.explanation =
           "for methods that can't be told a number: the option that is fitted to it; auto: "
           "horizontal_mesh, min_horizontal_spacing, step or value_tolerance; none: the options stay as they are"});
}

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
  const std::size_t variants = configuration.list_size(kVariants);
  OptionTable evaluation, synthetic, input, preparation, run;
  settings.evaluation.declare(evaluation);
  configuration.read_section(kSection, evaluation);
  for (std::size_t i = 0; i < variants; ++i) read_variant(configuration, fmt::format("{}[{}]", kVariants, i), settings);
  add_methods(configuration, settings);
  require_different_labels(configuration, settings.variants);
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
  for (const char* section : {"thinning", "output", "daemon", "window"}) configuration.ignore_section(section);
  if (Result<void> good = configuration.finish(); !good) return good.error();
  keep_resolved("evaluate", evaluation.without({"repetitions"}), settings);
  keep_resolved("synthetic", synthetic, settings);
  keep_resolved("input", input, settings);
  keep_resolved("preparation", preparation, settings);
  return settings;
}

}  // namespace thin
