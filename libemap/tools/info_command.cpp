// emap info: what an .emap file holds and where its bytes go.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "libemap/coding/elevation_coder.h"
#include "libemap/coding/stream.h"
#include "libemap/tools/commands.h"
#include "libemap/tools/emap_file.h"
#include "libemap/tools/failure.h"

namespace emap {
namespace {

struct Arguments {
  std::string input;
  bool as_json = false;
};

std::size_t samples_of(const ElevationPatch& patch) {
  return static_cast<std::size_t>(std::count(patch.mask.begin(), patch.mask.end(), 1));
}

std::size_t samples_of(const ElevationMaps& maps) {
  std::size_t samples = 0;
  for (const ElevationPatch& patch : maps.patches) samples += samples_of(patch);
  return samples;
}

std::string text_of(const DecodedStream& stream) {
  const StreamHeader& header = stream.header;
  const StreamParts& parts = stream.parts;
  const std::size_t bytes = parts.header + parts.planes + parts.masks + parts.elevations;
  std::string text = fmt::format(
      "  version             {}\n  coder               {}\n  from                {}\n  diagonal            {:.6g}\n"
      "  sample spacing      {:.6g} (1/{} of it)\n  quantiser's step    {:.6g}\n  patches             {}\n"
      "  samples             {}\n  bytes               {}\n",
      kStreamVersion, find_elevation_coder(header.coder)->name, header.from_points ? "points" : "a mesh",
      header.frame.box.diagonal(), header.frame.spacing(), header.frame.samples_per_diagonal, header.step(),
      header.patch_count, samples_of(stream.maps), bytes);
  for (const auto& [name, count] : {std::pair("header", parts.header),
                                    {"planes", parts.planes},
                                    {"masks", parts.masks},
                                    {"elevations", parts.elevations}})
    text += fmt::format("    {:<17} {:>9}  {:5.1f} %\n", name, count,
                        100 * static_cast<double>(count) / static_cast<double>(bytes));
  text += fmt::format("\n  {:>6}  {:>8}  {:>8}  {:>9}\n", "patch", "columns", "rows", "samples");
  for (std::size_t i = 0; i < stream.maps.patches.size(); ++i) {
    const ElevationPatch& patch = stream.maps.patches[i];
    text += fmt::format("  {:>6}  {:>8}  {:>8}  {:>9}\n", i, patch.columns, patch.rows, samples_of(patch));
  }
  return text;
}

nlohmann::ordered_json json_of(const DecodedStream& stream) {
  const StreamHeader& header = stream.header;
  const StreamParts& parts = stream.parts;
  nlohmann::ordered_json json = {
      {"version", kStreamVersion},
      {"coder", find_elevation_coder(header.coder)->name},
      {"from_points", header.from_points},
      {"diagonal", header.frame.box.diagonal()},
      {"spacing", header.frame.spacing()},
      {"samples_per_diagonal", header.frame.samples_per_diagonal},
      {"step", header.step()},
      {"samples", samples_of(stream.maps)},
      {"bytes",
       {{"header", parts.header}, {"planes", parts.planes}, {"masks", parts.masks}, {"elevations", parts.elevations}}},
      {"patches", nlohmann::ordered_json::array()}};
  for (const ElevationPatch& patch : stream.maps.patches)
    json["patches"].push_back({{"columns", patch.columns}, {"rows", patch.rows}, {"samples", samples_of(patch)}});
  return json;
}

int info(const Arguments& arguments) {
  const thin::Result<DecodedStream> decoded = read_emap_file(arguments.input);
  if (!decoded) return fail(decoded.error());
  const std::string text = arguments.as_json ? json_of(*decoded).dump(2) + "\n" : text_of(*decoded);
  std::fputs(text.c_str(), stdout);
  return std::fflush(stdout) == 0 ? 0 : thin::exit_code(thin::ErrorKind::temporary);
}

}  // namespace

void add_info_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand("info", "what a compressed file holds and where its bytes go");
  command->add_option("input", arguments->input, "Compressed file")->required()->type_name("IN.emap");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command->callback([arguments, &action] { action = [arguments] { return info(*arguments); }; });
}

}  // namespace emap
