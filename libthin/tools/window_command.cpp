// thin window: one window of staged files, thinned; the outputs extracted from the original files.

#include <fstream>
#include <memory>

#include "libthin/formats/staged_file.h"
#include "libthin/foundation/parallel.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/outcome.h"

namespace thin {
namespace {

struct Arguments {
  std::string configuration, plan, output;
};

struct Plan {
  TimeWindow window;
  std::vector<WindowFile> files;
};

std::optional<std::int64_t> optional_time(const OutcomeJson& plan, const char* key) {
  const auto found = plan.find(key);
  if (found == plan.end() || found->is_null()) return std::nullopt;
  return found->get<std::int64_t>();
}

// {"begin_ms": ..., "end_ms": ..., "files": [{"name": ..., "original": ..., "staged": ...}]}
Result<Plan> read_plan(const std::string& path) {
  std::ifstream file(path);
  Plan plan;
  try {
    const OutcomeJson json = OutcomeJson::parse(file);
    plan.window = {optional_time(json, "begin_ms"), optional_time(json, "end_ms")};
    for (const OutcomeJson& entry : json.at("files")) {
      Result<ReadObservations> staged = read_staged(entry.at("staged").get<std::string>());
      // Staged by us and whole when it was: what has become of it is not the fault of the observations in it.
      if (!staged) return Error{ErrorKind::internal, staged.error().message};
      plan.files.push_back(
          {entry.at("name").get<std::string>(), entry.at("original").get<std::string>(), std::move(*staged)});
    }
  } catch (const OutcomeJson::exception& error) {
    return Error{ErrorKind::configuration, "the plan " + path + " can't be read: " + error.what()};
  }
  if (plan.files.empty()) return Error{ErrorKind::configuration, "the plan " + path + " names no files"};
  return plan;
}

OutcomeJson done_json(const WindowOutcome& outcome) {
  OutcomeJson json = {{"outcome", "done"},
                      {"observations", outcome.prepared.observations.size()},
                      {"retained", outcome.retained.size()},
                      {"outputs", OutcomeJson::array()},
                      {"notes", outcome.prepared.notes},
                      {"seconds", seconds_json(outcome.seconds)},
                      {"report", kReportName}};
  for (const FileOutcome& file : outcome.files)
    if (file.output.messages > 0)
      json["outputs"].push_back({{"name", file.name}, {"bytes", file.output.bytes}, {"retained", file.retained}});
  return json;
}

int window(const Arguments& arguments) {
  const Result<Settings> settings = read_settings(arguments.configuration);
  if (!settings) return fail(settings.error());
  const ThreadLimit limit(settings->threads);
  Result<Plan> plan = read_plan(arguments.plan);
  if (!plan) return fail(plan.error());
  const Result<WindowOutcome> outcome =
      thin_window(std::move(plan->files), {}, plan->window, *settings, arguments.output);
  if (!outcome) return fail(outcome.error());
  print_outcome(done_json(*outcome));
  return 0;
}

}  // namespace

void add_window_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("window", "thin one window of staged files (a step of thind)");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-c,--config", arguments->configuration, "configuration file (TOML)")->required();
  command->add_option("--plan", arguments->plan, "JSON: the window and its files")->required();
  command->add_option("--output", arguments->output, "existing directory for the outputs")->required();
  command->callback([arguments, &action] { action = [arguments] { return window(*arguments); }; });
}

}  // namespace thin
