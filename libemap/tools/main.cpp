#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <new>

#include "libemap/tools/commands.h"
#include "libthin/foundation/result.h"
#include "libthin/foundation/version.h"

// Bad command line: as bad a configuration as a bad file.
constexpr int kConfigurationExit = 2;

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("emap"));
  spdlog::set_pattern("emap: %^%l%$: %v");

  CLI::App program("Densely sampled surfaces as elevation maps", "emap");
  program.set_version_flag("--version", thin::kVersion);
  program.require_subcommand(1);
  emap::Action action;
  emap::add_encode_command(program, action);
  emap::add_decode_command(program, action);
  emap::add_info_command(program, action);
  emap::add_compare_command(program, action);
  emap::add_page_command(program, action);
  emap::add_partition_command(program, action);
  emap::add_render_command(program, action);
  emap::add_resample_command(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? 0 : kConfigurationExit;
  }
  try {
    return action();
  } catch (const std::bad_alloc&) {
    spdlog::error("out of memory: choose a lower rate or a smaller model");
    return thin::exit_code(thin::ErrorKind::temporary);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return thin::exit_code(thin::ErrorKind::internal);
  }
}
