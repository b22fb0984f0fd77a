#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <new>

#include "libthin/foundation/result.h"
#include "libthin/foundation/version.h"
#include "libthin/tools/commands.h"

// Bad command line: as bad a configuration as a bad file.
constexpr int kConfigurationExit = 2;

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("thin"));
  spdlog::set_pattern("thin: %^%l%$: %v");

  CLI::App program("Adaptive thinning of satellite soundings", "thin");
  program.set_version_flag("--version", thin::kVersion);
  program.require_subcommand(1);
  thin::Action action;
  thin::add_run_command(program, action);
  thin::add_info_command(program, action);
  thin::add_methods_command(program, action);
  thin::add_synth_command(program, action);
  thin::add_evaluate_command(program, action);
  thin::add_twin_command(program, action);
  thin::add_check_command(program, action);
  thin::add_ingest_command(program, action);
  thin::add_window_command(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? 0 : kConfigurationExit;
  }
  try {
    return action();
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory: choose a smaller bandwidth_km, a coarser level or a shorter window");
    return thin::exit_code(thin::ErrorKind::temporary);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return thin::exit_code(thin::ErrorKind::internal);
  }
}
