// thin twin: the analysis error of thinned sets where the truth is known.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "libthin/formats/atomic_file.h"
#include "libthin/foundation/parallel.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/option_text.h"
#include "libthin/tools/outcome.h"
#include "libthin/tools/twin_report.h"

namespace thin {
namespace {

struct Arguments {
  std::string configuration, json;
  bool show_keys = false;
};

int show_keys() {
  TwinOptions options;
  TwinCycleOptions cycle_options;
  OptionTable table, cycle;
  options.declare(table);
  cycle_options.declare(cycle);
  fmt::print("[twin]: analysis errors at one time; [[twin.variant]] as [[evaluate.variant]]\n{}", options_text(table));
  fmt::print("[cycle]: instead, where cycles is not 0: forecast and analysis for weeks\n{}", options_text(cycle));
  return 0;
}

void complain(const std::vector<Evaluation::Failure>& failures, const TwinSettings& settings) {
  for (const Evaluation::Failure& failure : failures)
    spdlog::error("{}: {}", settings.variants[failure.variant].label, failure.reason);
}

Result<int> write(const Arguments& arguments, const std::string& table, const std::string& json) {
  fmt::print("{}", table);
  if (arguments.json.empty()) return 0;
  const Result<void> written = write_text_atomically(arguments.json, json);
  if (!written) return written.error();
  return 0;
}

Result<int> run(const Arguments& arguments) {
  if (arguments.show_keys) return show_keys();
  if (arguments.configuration.empty())
    return Error{ErrorKind::configuration, "name a configuration with -c; --keys shows what it may hold"};
  const Result<TwinSettings> settings = read_twin_settings(arguments.configuration);
  if (!settings) return settings.error();
  const ThreadLimit limit(settings->threads);
  const auto progress = [](const std::string& sentence) { spdlog::info("{}", sentence); };
  if (settings->cycle.cycles > 0) {
    const Result<TwinCycles> cycles =
        twin_cycles(settings->variants, settings->twin.observations, settings->cycle, settings->twin.seed, progress);
    if (!cycles) return cycles.error();
    complain(cycles->failures, *settings);
    return write(arguments, cycles_table(*cycles, *settings), cycles_json(*cycles, *settings));
  }
  const Result<Twin> twin = twin_experiment(settings->variants, settings->twin, progress);
  if (!twin) return twin.error();
  complain(twin->failures, *settings);
  return write(arguments, twin_table(*twin, *settings), twin_json(*twin, *settings));
}

}  // namespace

void add_twin_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "twin", "twin experiment: made-up truth, background and observations; the analysis error of thinned sets");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-c,--config", arguments->configuration, "configuration file (TOML) with [twin]");
  command->add_flag("--keys", arguments->show_keys, "show the keys of the configuration, and do nothing else");
  command->add_option("--json", arguments->json, "write the results here; the same bytes each time");
  command->callback([arguments, &action] { action = [arguments] { return finished(run(*arguments)); }; });
}

}  // namespace thin
