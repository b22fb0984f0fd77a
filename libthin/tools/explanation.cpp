#include "libthin/tools/explanation.h"

#include <fmt/format.h>

#include <map>

#include "libthin/observations/instruments.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

// "duplicates    120 of 5400 left out"
std::string step(int number, const std::string& name, const std::string& what) {
  return fmt::format("{} {:<12} {}\n", number, name, what);
}

std::string line(const std::string& what) {
  return "    " + what + "\n";
}

// The options of a part of [preparation] as they are in force.
template <class Options>
std::string options_of(Options options) {
  OptionTable table;
  options.declare(table);
  std::string text;
  for (const Option& option : table.options())
    text += line(fmt::format("{} = {}", option.name, option.current_value()));
  return text;
}

std::string options_of_section(const Settings& settings, const std::string& section) {
  std::string text;
  for (const auto& [name, value] : settings.resolved)
    if (name.starts_with(section + ".")) text += line(fmt::format("{} = {}", name.substr(section.size() + 1), value));
  return text;
}

std::string read_step(const WindowOutcome& outcome, const Settings& settings) {
  std::size_t observations = 0;
  std::string files;
  for (const FileOutcome& file : outcome.files) {
    observations += file.read;
    files += line(fmt::format("{}: {} observations, {} {}", file.name, file.read, file.layout, file.instrument));
    for (const std::string& note : file.notes) files += line("  " + note);
  }
  for (const RefusedFile& file : outcome.refused) files += line(fmt::format("{}: refused: {}", file.name, file.reason));
  return step(1, "read",
              fmt::format("{} observations of {} files, {} files refused", observations, outcome.files.size(),
                          outcome.refused.size())) +
         files + options_of_section(settings, "input");
}

std::string window_step(const WindowOutcome& outcome) {
  const auto time = [](const std::optional<std::int64_t>& ms, const char* otherwise) {
    return ms ? to_iso8601(*ms) : std::string(otherwise);
  };
  std::string sounders;
  std::size_t inside = 0;
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    inside += tally.observations;
    sounders += line(fmt::format("{}: {}", sounder_name(sounder), tally.observations));
  }
  return step(2, "window",
              fmt::format("from {} to before {}: {} inside, {} outside", time(outcome.window.begin_ms, "the first"),
                          time(outcome.window.end_ms, "the end"), inside, outcome.prepared.outside_window)) +
         sounders;
}

std::string duplicates_step(const WindowOutcome& outcome, const Settings& settings) {
  std::size_t near = 0, exact = 0;
  std::string sounders;
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    near += tally.near_duplicates;
    exact += tally.exact_duplicates;
    if (tally.duplicates() > 0)
      sounders += line(fmt::format("{}: {} of the same field of view, {} exact", sounder_name(sounder),
                                   tally.near_duplicates, tally.exact_duplicates));
  }
  return step(3, "duplicates", fmt::format("{} left out, {} of them exact", near + exact, exact)) + sounders +
         options_of(settings.preparation.duplicates);
}

std::string screening_step(const WindowOutcome& outcome, const Settings& settings) {
  std::map<ScreeningReason, std::map<Sounder, std::size_t>> reasons;
  std::size_t screened = 0;
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    screened += tally.screened_count();
    for (const auto& [reason, count] : tally.screened) reasons[reason][sounder] = count;
  }
  std::string text;
  for (const auto& [reason, counts] : reasons)
    for (const auto& [sounder, count] : counts)
      text +=
          line(fmt::format("{}: {} {}", sounder_name(sounder), count, name_of(reason, settings.preparation.screening)));
  if (outcome.prepared.surfaces_filled > 0)
    text += line(fmt::format("{} surfaces by the land/sea mask", outcome.prepared.surfaces_filled));
  return step(4, "screening", fmt::format("{} left out (those of steps 5 and 6 among them)", screened)) + text +
         options_of(settings.preparation.screening) + options_of(settings.preparation.surface);
}

std::string bias_step(const WindowOutcome& outcome, const Settings& settings) {
  const BiasCounts& bias = outcome.prepared.bias;
  const BiasOptions& options = settings.preparation.bias;
  return step(5, "bias",
              options.any() ? fmt::format("{} corrected, {} without correction", bias.corrected, bias.uncorrected)
                            : std::string("none")) +
         options_of(options);
}

std::string first_guess_step(const WindowOutcome& outcome, const Settings& settings) {
  const FirstGuessCounts& counts = outcome.prepared.first_guess;
  const PreparationOptions& options = settings.preparation;
  std::string text =
      step(6, "first guess",
           fmt::format("{} of a file, {} mean of the scan position, {} none, {} innovations as they came", counts.given,
                       counts.scan_position_mean, counts.none, counts.innovations)) +
      options_of(options.first_guess);
  if (options.first_guess.first_guess == FirstGuess::companion) text += options_of(options.companions);
  for (const std::string& note : outcome.prepared.notes) text += line("note: " + note);
  return text;
}

std::string thinning_step(const WindowOutcome& outcome, const Settings& settings) {
  const ObservationSet& prepared = outcome.prepared.observations;
  std::map<Instrument, std::string> channels;
  for (std::size_t place = 0; place < prepared.channel_count(); ++place)
    channels[instrument_of_channel(prepared, place)] += fmt::format(" {}", prepared.channels[place]);
  std::string text;
  for (const auto& [instrument, numbers] : channels)
    text += line(fmt::format("{}: channels{}", instrument_name(instrument), numbers));
  for (const auto& [sounder, tally] : outcome.prepared.sounders) {
    const auto retained = outcome.retained_by_sounder.find(sounder);
    text += line(fmt::format("{}: {} of {}", sounder_name(sounder),
                             retained == outcome.retained_by_sounder.end() ? 0 : retained->second, tally.prepared));
  }
  return step(7, "thinning",
              fmt::format("{}: {} of {} retained", settings.method_name, outcome.retained.size(), prepared.size())) +
         text + options_of_section(settings, "thinning");
}

std::string output_step(const WindowOutcome& outcome, const Settings& settings) {
  std::string files;
  std::size_t count = 0;
  for (const FileOutcome& file : outcome.files) {
    count += file.output.messages > 0;
    files += line(file.output.messages > 0 ? fmt::format("{}: {} of {} observations, {} bytes", file.name,
                                                         file.retained, file.read, file.output.bytes)
                                           : file.name + ": nothing of it is retained, no file");
  }
  return step(8, "output", fmt::format("{} files and {}", count, kReportName)) + files +
         options_of_section(settings, "output");
}

}  // namespace

std::string explanation(const WindowOutcome& outcome, const Settings& settings) {
  return read_step(outcome, settings) + window_step(outcome) + duplicates_step(outcome, settings) +
         screening_step(outcome, settings) + bias_step(outcome, settings) + first_guess_step(outcome, settings) +
         thinning_step(outcome, settings) + output_step(outcome, settings);
}

}  // namespace thin
