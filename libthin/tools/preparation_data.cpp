#include "libthin/tools/preparation_data.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <filesystem>

#include "libthin/formats/shoreline_file.h"
#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

Result<std::string> read_text(const std::string& path, const char* key) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (bytes) return std::string(bytes->begin(), bytes->end());
  if (bytes.error().kind == ErrorKind::temporary) return bytes.error();
  return Error{ErrorKind::configuration, fmt::format("[preparation] {}: {}", key, bytes.error().message)};
}

// Reads the table that an option names; leaves it unset where the option is empty.
template <class Table>
Result<void> read_table(const std::string& path, const char* key, std::optional<Table>& table) {
  if (path.empty()) return {};
  const Result<std::string> text = read_text(path, key);
  if (!text) return text.error();
  Result<Table> parsed = Table::parse(*text, path);
  if (!parsed) return parsed.error();
  table = std::move(*parsed);
  return {};
}

// By name.
Result<std::vector<std::string>> matching_files(const std::vector<std::string>& patterns) {
  std::vector<std::string> paths;
  for (const std::string& pattern : patterns) {
    glob_t found{};
    const int failed = ::glob(pattern.c_str(), 0, nullptr, &found);
    if (!failed) paths.insert(paths.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
    ::globfree(&found);
    if (failed)
      return Error{ErrorKind::temporary,
                   fmt::format("[preparation] companion_files: no file {} is there yet", pattern)};
  }
  std::sort(paths.begin(), paths.end());
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return paths;
}

}  // namespace

void make_paths_absolute(PreparationOptions& options, const std::string& folder) {
  const auto complete = [&](std::string& path) {
    if (!path.empty()) path = (std::filesystem::path(folder) / path).lexically_normal().string();
  };
  complete(options.surface.land_sea_mask);
  complete(options.bias.table);
  complete(options.bias.predictors);
  for (std::string& path : options.companions.files) complete(path);
}

Result<PreparationData> read_preparation_data(const PreparationOptions& options) {
  PreparationData data;
  if (!options.screening.surfaces.empty()) {
    const Result<std::vector<ShoreEdge>> edges = read_shoreline(options.surface.land_sea_mask);
    if (!edges) return edges.error();
    data.shoreline.emplace(*edges);
  }
  if (Result<void> read = read_table(options.bias.table, "bias_table", data.bias_table); !read) return read.error();
  if (Result<void> read = read_table(options.bias.predictors, "bias_predictors", data.bias_predictors); !read)
    return read.error();
  return data;
}

Result<std::optional<ObservationSet>> read_companions(const PreparationOptions& options, const InputOptions& input) {
  if (options.first_guess.first_guess != FirstGuess::companion) return std::optional<ObservationSet>();
  const Result<std::vector<std::string>> paths = matching_files(options.companions.files);
  if (!paths) return paths.error();
  ObservationSet companions;
  for (const std::string& path : *paths) {
    Result<ReadObservations> contents = read_observations(path, input);
    if (!contents) return contents.error();
    ObservationSet& observations = contents->observations;
    if (observations.first_guess_k.empty())
      return Error{ErrorKind::input, fmt::format("{}: it has no first guess; [preparation] companion_files must name "
                                                 "files with model equivalents",
                                                 path)};
    // Of companions only places and first guesses are looked at.
    observations.value_kind = ValueKind::brightness_temperature;
    companions.append(observations);
  }
  return std::optional(std::move(companions));
}

}  // namespace thin
