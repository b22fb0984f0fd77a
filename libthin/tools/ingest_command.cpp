// thin ingest: one file, decoded in a process of its own, staged for `thin window`.

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "libthin/formats/atomic_file.h"
#include "libthin/formats/staged_file.h"
#include "libthin/observations/platforms.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/outcome.h"
#include "libthin/tools/settings.h"

namespace thin {
namespace {

struct Arguments {
  std::string configuration, input, output;
};

OutcomeJson staged_json(const ReadObservations& contents) {
  const ObservationSet& set = contents.observations;
  const auto [first, last] = std::minmax_element(set.time_ms.begin(), set.time_ms.end());
  std::map<std::int32_t, std::size_t> platforms;
  for (const std::int32_t platform : set.platform) ++platforms[platform];
  OutcomeJson json = {{"outcome", "staged"},
                      {"layout", contents.layout},
                      {"instrument", contents.instrument},
                      {"observations", set.size()},
                      {"time_begin_ms", *first},
                      {"time_end_ms", *last},
                      {"platforms", OutcomeJson::array()},
                      {"skipped", OutcomeJson::array()}};
  for (const auto& [platform, count] : platforms)
    json["platforms"].push_back({{"number", platform}, {"name", platform_name(platform)}, {"observations", count}});
  for (const SkippedPart& part : contents.skipped)
    json["skipped"].push_back({{"message", part.message}, {"offset", part.offset}, {"reason", part.reason}});
  return json;
}

int ingest(const Arguments& arguments) {
  InputOptions input;
  OutputOptions output;
  if (!arguments.configuration.empty()) {
    const Result<Settings> settings = read_settings(arguments.configuration);
    if (!settings) return fail(settings.error());
    input = settings->input;
    output = settings->output;
  }

  StepSeconds seconds;
  StepClock clock(seconds);
  const Result<ReadObservations> contents = read_observations(arguments.input, input);
  if (!contents) return fail(without_path(contents.error(), arguments.input));
  if (contents->observations.size() == 0) return fail({ErrorKind::input, "it holds no observation that can be used"});
  if (const Result<void> possible = check_output(contents->layout, output); !possible) return fail(possible.error());
  clock.finish("read");

  const std::string temporary = arguments.output + ".tmp";
  Result<void> staged = write_staged(temporary, *contents);
  if (staged) staged = publish_file(temporary, arguments.output);
  if (!staged) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    return fail(staged.error());
  }
  clock.finish("stage");

  OutcomeJson outcome = staged_json(*contents);
  outcome["seconds"] = seconds_json(seconds);
  print_outcome(outcome);
  return 0;
}

}  // namespace

void add_ingest_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("ingest", "decode one file and stage it (a step of thind)");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-c,--config", arguments->configuration, "configuration file (TOML)");
  command->add_option("--input", arguments->input, "file of soundings")->required();
  command->add_option("--output", arguments->output, "staged file to write")->required();
  command->callback([arguments, &action] { action = [arguments] { return ingest(*arguments); }; });
}

}  // namespace thin
