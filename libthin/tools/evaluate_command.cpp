// thin evaluate: methods and numbers to retain compared, on files or on made-up observations.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <numeric>
#include <random>

#include "libthin/formats/atomic_file.h"
#include "libthin/foundation/parallel.h"
#include "libthin/tools/commands.h"
#include "libthin/tools/evaluation_report.h"
#include "libthin/tools/option_text.h"
#include "libthin/tools/outcome.h"
#include "libthin/tools/preparation_data.h"
#include "libthin/tools/withholding_report.h"

namespace thin {
namespace {

struct Arguments {
  std::string configuration, json, csv, costs;
  std::vector<std::string> files;
  std::optional<std::uint64_t> shuffle;
  std::optional<double> withhold;
  bool show_keys = false;
};

template <class Options>
void print_section(const char* name, const char* explanation) {
  Options options;
  OptionTable table;
  options.declare(table);
  fmt::print("{}: {}\n{}", name, explanation, options_text(table));
}

int show_keys() {
  print_section<EvaluationOptions>("[evaluate]", "what is compared, and how it is measured");
  print_section<WithholdingOptions>("[evaluate]", "by cross-validation");
  print_section<VariantKeys>("[[evaluate.variant]]", "a method with options; as many as wanted");
  print_section<SyntheticOptions>("[synthetic]", "made-up observations instead of files");
  fmt::print("[input], [preparation] and [run] are as for thin run.\n");
  return 0;
}

Result<ObservationSet> observations_of(const Arguments& arguments, const EvaluationSettings& settings) {
  const bool made_up = settings.synthetic.source != SyntheticOptions::Source::none;
  if (made_up == !arguments.files.empty())
    return Error{ErrorKind::configuration,
                 made_up ? "files are given, but [synthetic] source asks for made-up observations; remove one"
                         : "name files to evaluate on, or set [synthetic] source"};
  if (made_up) return settings.synthetic.make();
  ObservationSet all;
  for (std::size_t file = 0; file < arguments.files.size(); ++file) {
    const std::string& path = arguments.files[file];
    const Result<ReadObservations> contents = read_observations(path, settings.input);
    if (!contents) return contents.error();
    for (const SkippedPart& part : contents->skipped)
      spdlog::warn("{}: message {} at byte {}: {}", path, part.message, part.offset, part.reason);
    const std::size_t first = all.size();
    all.append(contents->observations);
    for (std::size_t i = first; i < all.size(); ++i) all.source[i].file = static_cast<std::uint32_t>(file);
  }
  return all;
}

// In an order of the seed, to show that results don't depend on it.
ObservationSet shuffled(const ObservationSet& set, std::uint64_t seed) {
  std::vector<std::uint32_t> order(set.size());
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937_64 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  return set.select(order);
}

Result<void> write_files(const Arguments& arguments, const Evaluation& evaluation, const EvaluationSettings& settings,
                         const Prepared& prepared) {
  if (!arguments.json.empty())
    if (auto written = write_text_atomically(
            arguments.json, evaluation_json(evaluation, settings, prepared.observations, prepared.notes));
        !written)
      return written;
  if (!arguments.csv.empty())
    if (auto written = write_text_atomically(arguments.csv, evaluation_csv(evaluation, settings)); !written)
      return written;
  if (!arguments.costs.empty()) return write_text_atomically(arguments.costs, costs_csv(evaluation, settings.variants));
  return {};
}

void set_share(EvaluationSettings& settings, double share) {
  settings.withholding.share = share;
  for (auto& [name, value] : settings.resolved)
    if (name == "evaluate.withhold") value = fmt::format("{}", share);
}

// Instead of evaluate(), where a share is to be withheld.
Result<int> cross_validate(const Arguments& arguments, const EvaluationSettings& settings, const Prepared& prepared) {
  if (!arguments.csv.empty() || !arguments.costs.empty())
    return Error{ErrorKind::configuration,
                 "--csv and --costs don't go with cross-validation; its numbers are in --json"};
  const ObservationSet& set = prepared.observations;
  const Result<Withholding> withholding =
      withhold(set, settings.variants, settings.evaluation.counts, settings.withholding,
               [](const std::string& sentence) { spdlog::info("{}", sentence); });
  if (!withholding) return withholding.error();
  for (const std::string& note : withholding->notes) spdlog::warn("{}", note);
  for (const Evaluation::Failure& failure : withholding->failures)
    spdlog::error("{}: {}", settings.variants[failure.variant].label, failure.reason);
  fmt::print("{}", withholding_table(*withholding, settings, set));
  if (arguments.json.empty()) return 0;
  const Result<void> written =
      write_text_atomically(arguments.json, withholding_json(*withholding, settings, set, prepared.notes));
  if (!written) return written.error();
  return 0;
}

Result<int> run(const Arguments& arguments) {
  if (arguments.show_keys) return show_keys();
  if (arguments.configuration.empty())
    return Error{ErrorKind::configuration, "name a configuration with -c; --keys shows what it may hold"};
  Result<EvaluationSettings> settings = read_evaluation_settings(arguments.configuration);
  if (!settings) return settings.error();
  if (arguments.withhold) set_share(*settings, *arguments.withhold);
  const ThreadLimit limit(settings->threads);
  Result<ObservationSet> all = observations_of(arguments, *settings);
  if (!all) return all.error();
  if (arguments.shuffle) all = shuffled(*all, *arguments.shuffle);
  Result<PreparationData> data = read_preparation_data(settings->preparation);
  if (!data) return data.error();
  Result<std::optional<ObservationSet>> companions = read_companions(settings->preparation, settings->input);
  if (!companions) return companions.error();
  data->companions = std::move(*companions);
  data->file_names = arguments.files;
  const Result<Prepared> prepared = prepare(*all, {}, settings->preparation, *data);
  if (!prepared) return prepared.error();
  if (prepared->observations.size() == 0)
    return Error{ErrorKind::input, fmt::format("nothing is left to evaluate on: all {} observations were screened out; "
                                               "see [preparation] for the channels and limits",
                                               all->size())};
  for (const std::string& note : prepared->notes) spdlog::warn("{}", note);

  if (settings->withholding.share > 0) return cross_validate(arguments, *settings, *prepared);
  const Result<Evaluation> evaluation = evaluate(prepared->observations, settings->variants, settings->evaluation,
                                                 [](const std::string& sentence) { spdlog::info("{}", sentence); });
  if (!evaluation) return evaluation.error();
  for (const Evaluation::Failure& failure : evaluation->failures)
    spdlog::error("{}: {}", settings->variants[failure.variant].label, failure.reason);
  fmt::print("{}", evaluation_table(*evaluation, *settings));
  if (Result<void> written = write_files(arguments, *evaluation, *settings, *prepared); !written)
    return written.error();
  return evaluation->results.empty() ? exit_code(ErrorKind::input) : 0;
}

}  // namespace

void add_evaluate_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "evaluate", "compare methods over numbers to retain: errors, separations, densities, seconds, memory");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("-c,--config", arguments->configuration, "configuration file (TOML) with [evaluate]");
  command->add_flag("--keys", arguments->show_keys, "show the keys of the configuration, and do nothing else");
  command->add_option("--json", arguments->json, "write the results here; the same bytes each time");
  command->add_option("--csv", arguments->csv, "write a line for each result here; the same bytes each time");
  command->add_option("--costs", arguments->costs, "write seconds and memory here (CSV)");
  command->add_option("--shuffle", arguments->shuffle,
                      "bring the observations into the order of this seed first: nothing may change");
  command
      ->add_option("--withhold", arguments->withhold,
                   "cross-validate: withhold this share, predict it from what is retained of the rest")
      ->check(CLI::Range(0.01, 0.9));
  command->add_option("files", arguments->files, "files of soundings; none with [synthetic] source");
  command->callback([arguments, &action] { action = [arguments] { return finished(run(*arguments)); }; });
}

}  // namespace thin
