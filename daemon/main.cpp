// thind: watches an inbox for satellite soundings and emits thinned sets of them.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "daemon/daemon.h"
#include "daemon/log.h"
#include "daemon/status.h"
#include "libthin/foundation/version.h"

namespace {

struct Arguments {
  std::string configuration = "/etc/thind/thind.toml";
  bool once = false, check = false, status = false, json = false;
};

int fail(const thin::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return thin::exit_code(error.kind);
}

int print_status(const thind::Settings& settings, bool json) {
  const auto status = thind::read_status(settings, json);
  if (!status) return fail(status.error());
  std::fputs(status->text.c_str(), stdout);
  return status->consistent ? 0 : 1;
}

int run(const Arguments& arguments) {
  auto settings = thind::read_settings(arguments.configuration);
  if (!settings) return fail(settings.error());
  if (arguments.status) return print_status(*settings, arguments.json);
  if (auto checked = thind::check_with_worker(*settings); !checked) return fail(checked.error());
  if (arguments.check) return 0;
  if (auto logging = thind::set_up_log(settings->daemon.log); !logging) return fail(logging.error());
  auto status = thind::Daemon(std::move(*settings), arguments.once).run();
  return status ? *status : fail(status.error());
}

}  // namespace

int main(int argument_count, char** argument_values) {
  CLI::App program("Watches an inbox for satellite soundings, thins them, and hands on files of the same format.");
  Arguments arguments;
  program.set_version_flag("--version", thin::kVersion);
  program.add_option("-c,--config", arguments.configuration, "configuration file")->capture_default_str();
  auto* once = program.add_flag("--once", arguments.once, "drain the inbox, close all windows, and end");
  auto* check = program.add_flag("--check", arguments.check, "check the configuration, and end");
  auto* status = program.add_flag("--status", arguments.status, "print what the journal says, and end");
  program.add_flag("--json", arguments.json, "with --status: as JSON")->needs(status);
  once->excludes(check)->excludes(status);
  check->excludes(status);
  try {
    program.parse(argument_count, argument_values);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : thin::exit_code(thin::ErrorKind::configuration);
  }
  return run(arguments);
}
