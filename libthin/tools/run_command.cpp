// thin run: the whole way for one window, from files to thinned files.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <map>
#include <memory>

#include "libthin/foundation/parallel.h"
#include "libthin/observations/time.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/explanation.h"
#include "libthin/tools/outcome.h"
#include "libthin/tools/report.h"

namespace thin {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string configuration, output, begin, end;
  std::vector<std::string> files;
  bool as_json = false;
  bool explain = false;
};

Result<TimeWindow> window_of(const Arguments& arguments) {
  TimeWindow window;
  for (const auto& [text, limit] : {std::pair(&arguments.begin, &window.begin_ms), {&arguments.end, &window.end_ms}}) {
    if (text->empty()) continue;
    *limit = from_iso8601(*text);
    if (!*limit)
      return Error{ErrorKind::configuration, fmt::format("\"{}\" is no time; write 2004-07-21T22:30:00Z", *text)};
  }
  return window;
}

// Every output has a name of its own, and none is an input.
Result<void> check_names(const Arguments& arguments) {
  std::map<std::string, std::string> by_name = {{kReportName, "the report"}};
  for (const std::string& file : arguments.files) {
    const std::string name = fs::path(file).filename();
    const auto [other, is_new] = by_name.try_emplace(name, file);
    if (!is_new)
      return Error{ErrorKind::configuration,
                   fmt::format("{} and {} would both be written to {}/{}; rename one, or run them apart", other->second,
                               file, arguments.output, name)};
    std::error_code ignored;
    if (fs::equivalent(file, fs::path(arguments.output) / name, ignored))
      return Error{ErrorKind::configuration,
                   fmt::format("the output would replace the input {}; choose another directory with -o", file)};
  }
  return {};
}

struct Inputs {
  std::vector<WindowFile> files;
  std::vector<RefusedFile> refused;
};

// Reads what can be read. Errors: temporary ones; what is wrong with a file refuses that file alone.
Result<Inputs> read_inputs(const std::vector<std::string>& paths, const Settings& settings) {
  Inputs inputs;
  for (const std::string& path : paths) {
    Result<ReadObservations> contents = read_observations(path, settings.input);
    const std::string name = fs::path(path).filename();
    if (contents)
      if (const Result<void> possible = check_output(contents->layout, settings.output); !possible)
        contents = possible.error();
    if (contents && contents->observations.size() > 0) {
      for (const SkippedPart& part : contents->skipped)
        spdlog::warn("{}: message {} at byte {}: {}", path, part.message, part.offset, part.reason);
      inputs.files.push_back({name, path, std::move(*contents)});
      continue;
    }
    const Error error = contents ? Error{ErrorKind::input, "it holds no observation that can be used"}
                                 : without_path(contents.error(), path);
    if (error.kind == ErrorKind::temporary) return contents.error();
    spdlog::error("{}: {}", path, error.message);
    inputs.refused.push_back({name, error.message});
  }
  if (inputs.files.empty())
    return Error{ErrorKind::input, fmt::format("none of the {} files can be used", paths.size())};
  return inputs;
}

void print(const WindowOutcome& outcome, const Settings& settings, const Arguments& arguments) {
  for (const std::string& note : outcome.prepared.notes) spdlog::warn("{}", note);
  if (!arguments.as_json) {
    if (arguments.explain) fmt::print("{}\n", explanation(outcome, settings));
    fmt::print("{}", report_table(outcome));
    return;
  }
  OutcomeJson json = OutcomeJson::parse(report_json(outcome, settings));
  json["seconds"] = seconds_json(outcome.seconds);
  fmt::print("{}\n", json.dump(2));
}

Result<int> run(const Arguments& arguments) {
  const Result<Settings> settings = read_settings(arguments.configuration);
  if (!settings) return settings.error();
  const ThreadLimit limit(settings->threads);
  const Result<TimeWindow> window = window_of(arguments);
  if (!window) return window.error();
  if (Result<void> names = check_names(arguments); !names) return names.error();
  std::error_code failed;
  fs::create_directories(arguments.output, failed);
  if (failed) return system_error("create the directory", arguments.output, failed.value());

  StepSeconds seconds;
  StepClock clock(seconds);
  Result<Inputs> inputs = read_inputs(arguments.files, *settings);
  if (!inputs) return inputs.error();
  clock.finish("read");
  const bool some_refused = !inputs->refused.empty();
  Result<WindowOutcome> outcome =
      thin_window(std::move(inputs->files), std::move(inputs->refused), *window, *settings, arguments.output);
  if (!outcome) return outcome.error();
  outcome->seconds.insert(outcome->seconds.begin(), seconds.begin(), seconds.end());
  print(*outcome, *settings, arguments);
  return some_refused ? exit_code(ErrorKind::input) : 0;
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("run", "thin the files of one window: the whole way");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-c,--config", arguments->configuration, "configuration file (TOML)")->required();
  command->add_option("-o,--output", arguments->output, "directory for the thinned files and report.json")->required();
  command->add_option("--begin", arguments->begin, "observations from this time on, 2004-07-21T22:30:00Z");
  command->add_option("--end", arguments->end, "observations before this time");
  command->add_flag("--json", arguments->as_json, "print the report and the seconds per step as JSON");
  command
      ->add_flag("--explain", arguments->explain,
                 "print the resolved way, step by step, with what each step left out; the outputs are the same")
      ->excludes("--json");
  command->add_option("files", arguments->files, "files of soundings")->required();
  command->callback([arguments, &action] { action = [arguments] { return finished(run(*arguments)); }; });
}

}  // namespace thin
