#pragma once

// One TOML file tells the whole way of a window. The daemon's own sections stand in the same file and are left to it.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "libthin/formats/observation_file.h"
#include "libthin/foundation/configuration.h"
#include "libthin/preparation/preparation.h"
#include "libthin/thinning/thinner.h"
#include "libthin/tools/preparation_data.h"

namespace thin {

struct Settings {
  std::string method_name = "grid_eea";
  std::unique_ptr<Thinner> thinner;
  InputOptions input;
  PreparationOptions preparation;
  OutputOptions output;
  int threads = 0;

  // Every option with the value in force, as "section.name", for the report.
  std::vector<std::pair<std::string, std::string>> resolved;
};

// Error: configuration, with a line for every problem in the file. Relative paths in [preparation] start at the
// configuration's folder; `resolved` has them as they are written, for reports must not depend on where that lies.
Result<Settings> read_settings(const std::string& path);
Result<Settings> read_settings(Configuration configuration);

// The method of that name. Where there is none: nothing, and a problem at section.key.
std::unique_ptr<Thinner> thinner_named(Configuration& configuration, const std::string& section, const std::string& key,
                                       const std::string& name);

// The method that section.method names; `name` is the default, and becomes the name.
std::unique_ptr<Thinner> thinner_named_in(Configuration& configuration, const std::string& section, std::string& name);

// Everything else that stands in the same file is for other commands, or for the daemon. To be called last.
void ignore_other_sections(Configuration& configuration);

// The settings of a file by `read`, which takes its Configuration; relative paths in [preparation] start at its folder.
template <class Read>
auto read_settings_file(const std::string& path, const Read& read) -> decltype(read(std::declval<Configuration>())) {
  Result<Configuration> configuration = Configuration::read(path);
  if (!configuration) return configuration.error();
  auto settings = read(std::move(*configuration));
  std::error_code ignored;
  const std::filesystem::path absolute = std::filesystem::absolute(path, ignored);
  if (settings) make_paths_absolute(settings->preparation, absolute.parent_path().string());
  return settings;
}

// Every option with the value in force, as "section.name".
using ResolvedOptions = std::vector<std::pair<std::string, std::string>>;
void keep_resolved(const std::string& section, const OptionTable& table, ResolvedOptions& resolved);

// [run]: nothing in a result depends on it.
void declare_run_options(OptionTable& table, int& threads);

}  // namespace thin
