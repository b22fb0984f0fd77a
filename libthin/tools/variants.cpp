#include "libthin/tools/variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "libthin/analysis/count_fitting.h"
#include "libthin/tools/settings.h"

namespace thin {
namespace {

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

void read_variant(Configuration& configuration, const std::string& section, std::optional<double> bandwidth_km,
                  std::vector<Variant>& variants) {
  VariantKeys keys;
  std::unique_ptr<Thinner> thinner = thinner_named_in(configuration, section, keys.method);
  if (!thinner) return;
  const bool has_rule = configuration.peek_text(section, "bandwidth").value_or("fixed") != "fixed";
  Variant variant = variant_of(std::move(thinner), has_rule ? std::nullopt : bandwidth_km);
  OptionTable table = variant.options.without({"retain_count", "retain_fraction"});
  keys.declare(table);
  configuration.read_section(section, table);
  variant.label = keys.label.empty() ? keys.method : keys.label;
  variant.fit = fitted_option(variant, keys.fit);
  if (!variant.fit.empty() && !variant.options.find(variant.fit))
    configuration.add_problem(section, "fit", fmt::format("= \"{}\" is no option of {}", keys.fit, keys.method));
  if (const auto conflict = variant.thinner->conflict())
    configuration.add_problem(section, conflict->key, conflict->problem);
  variants.push_back(std::move(variant));
}

void add_methods(Configuration& configuration, const std::string& section, std::vector<std::string> names,
                 std::optional<double> bandwidth_km, std::vector<Variant>& variants) {
  if (names.empty() && variants.empty())
    for (const MethodEntry& entry : thinning_methods()) names.push_back(entry.name);
  for (const std::string& name : names) {
    std::unique_ptr<Thinner> thinner = thinner_named(configuration, section, "methods", name);
    if (!thinner) continue;
    Variant variant = variant_of(std::move(thinner), bandwidth_km);
    variant.label = name;
    variant.fit = fitted_option(variant, "auto");
    variants.push_back(std::move(variant));
  }
}

void require_different_labels(Configuration& configuration, const std::string& section,
                              const std::vector<Variant>& variants) {
  std::vector<std::string> labels;
  for (const Variant& variant : variants) labels.push_back(variant.label);
  std::sort(labels.begin(), labels.end());
  for (auto twice = std::adjacent_find(labels.begin(), labels.end()); twice != labels.end();
       twice = std::adjacent_find(std::upper_bound(twice, labels.end(), *twice), labels.end()))
    configuration.add_problem(
        section, "methods",
        fmt::format("and [[{}.variant]] give two variants the label \"{}\"; set label", section, *twice));
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

std::vector<Variant> read_variants(Configuration& configuration, const std::string& section, std::size_t count,
                                   const std::vector<std::string>& methods, std::optional<double> bandwidth_km) {
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < count; ++i)
    read_variant(configuration, fmt::format("{}.variant[{}]", section, i), bandwidth_km, variants);
  add_methods(configuration, section, methods, bandwidth_km, variants);
  require_different_labels(configuration, section, variants);
  return variants;
}

}  // namespace thin
