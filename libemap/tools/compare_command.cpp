// emap compare: the distance between two surfaces, for people or as JSON.

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "libemap/surface/surface_distance.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/failure.h"

namespace emap {
namespace {

struct CompareArguments {
  std::string first, second;
  ComparisonOptions options;
  bool as_json = false;
};

std::string text_of(const SurfaceComparison& comparison) {
  const auto line = [&](const char* name, const OneSidedDistance& distance) {
    return fmt::format("  {:<18} rms {:10.4f}   max {:10.4f}\n", name,
                       distance.root_mean_square / comparison.diagonal * 1e4,
                       distance.maximum / comparison.diagonal * 1e4);
  };
  return fmt::format("  diagonal           {:.6g}; distances in 1e-4 of it\n", comparison.diagonal) +
         line("first to second", comparison.first_to_second) + line("second to first", comparison.second_to_first) +
         fmt::format("  E_rms              {:.4f}\n  PSNR               {:.2f} dB\n", comparison.error_in_1e4(),
                     comparison.psnr_db());
}

nlohmann::ordered_json json_of(const SurfaceComparison& comparison) {
  const auto json = [](const OneSidedDistance& distance) {
    return nlohmann::ordered_json{{"rms", distance.root_mean_square}, {"maximum", distance.maximum}};
  };
  // JSON has no infinity: null where the surfaces are the same.
  const double psnr_db = comparison.psnr_db();
  return {{"diagonal", comparison.diagonal},
          {"first_to_second", json(comparison.first_to_second)},
          {"second_to_first", json(comparison.second_to_first)},
          {"e_rms", comparison.error()},
          {"e_rms_1e4_diagonals", comparison.error_in_1e4()},
          {"psnr_db", std::isfinite(psnr_db) ? nlohmann::ordered_json(psnr_db) : nlohmann::ordered_json(nullptr)}};
}

int compare(const CompareArguments& arguments) {
  const thin::Result<Model> first = read_model(arguments.first);
  if (!first) return fail(first.error());
  const thin::Result<Model> second = read_model(arguments.second);
  if (!second) return fail(second.error());
  const thin::Result<SurfaceComparison> comparison = compare_surfaces(*first, *second, arguments.options);
  if (!comparison) return fail(comparison.error());
  const std::string text = arguments.as_json ? json_of(*comparison).dump(2) + "\n" : text_of(*comparison);
  std::fputs(text.c_str(), stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

}  // namespace

void add_compare_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = program.add_subcommand("compare", "distance between two surfaces: E_rms and PSNR");
  command->add_option("first", arguments->first, "The original, whose diagonal is the unit")
      ->required()
      ->type_name("FILE");
  command->add_option("second", arguments->second, "The other surface")->required()->type_name("FILE");
  command->add_option("--samples", arguments->options.samples, "Samples on each mesh [200000]")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", arguments->options.seed, "Of the samples' places [1]");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command->callback([arguments, &action] { action = [arguments] { return compare(*arguments); }; });
}

}  // namespace emap
