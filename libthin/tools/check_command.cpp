// thin check: is this configuration good? For people, for `thind --check`, and before every reload.

#include <fmt/format.h>

#include <memory>

#include "libthin/tools/commands.h"
#include "libthin/tools/preparation_data.h"
#include "libthin/tools/settings.h"

namespace thin {

void add_check_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("check", "validate a configuration, and print what it resolves to");
  const auto path = std::make_shared<std::string>();
  command->add_option("-c,--config", *path, "configuration file (TOML)")->required();
  command->callback([path, &action] {
    action = [path] {
      const Result<Settings> settings = read_settings(*path);
      if (!settings) {
        fmt::print(stderr, "{}\n", settings.error().message);
        return exit_code(settings.error().kind);
      }
      if (const Result<PreparationData> data = read_preparation_data(settings->preparation); !data) {
        fmt::print(stderr, "{}\n", data.error().message);
        return exit_code(data.error().kind);
      }
      for (const auto& [name, value] : settings->resolved) fmt::print("{} = {}\n", name, value);
      return 0;
    };
  });
}

}  // namespace thin
