#include "libthin/tools/window_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "libthin/formats/atomic_file.h"
#include "libthin/tools/instrument_parts.h"
#include "libthin/tools/preparation_data.h"
#include "libthin/tools/report.h"
#include "libthin/tools/superobs.h"

namespace thin {
namespace {

// Of the filter that the report's error is taken with, for methods that have none of their own.
constexpr double kReportBandwidthKm = 100;

// All observations in one set; source.file is the place of the file in `files`.
ObservationSet merged(const std::vector<WindowFile>& files) {
  ObservationSet all;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::size_t first = all.size();
    all.append(files[i].contents.observations);
    for (std::size_t j = first; j < all.size(); ++j) all.source[j].file = static_cast<std::uint32_t>(i);
  }
  return all;
}

Error nothing_left(const Prepared& prepared, const ObservationSet& all, const ScreeningOptions& options) {
  std::size_t duplicates = 0, screened = 0;
  std::map<ScreeningReason, std::size_t> reasons;
  for (const auto& [sounder, tally] : prepared.sounders) {
    duplicates += tally.duplicates();
    screened += tally.screened_count();
    for (const auto& [reason, count] : tally.screened) reasons[reason] += count;
  }
  std::string why;
  for (const auto& [reason, count] : reasons)
    why += fmt::format("{}{} {}", why.empty() ? " (" : ", ", count, name_of(reason, options));
  return {
      ErrorKind::input,
      fmt::format("nothing is left to thin: of {} observations {} lie outside the window, {} are duplicates, and {} "
                  "were screened out{}; see [preparation] for the channels, limits and rules",
                  all.size(), prepared.outside_window, duplicates, screened, why.empty() ? "" : why + ")")};
}

Result<Prepared> prepare_files(const std::vector<WindowFile>& files, const ObservationSet& all,
                               const TimeWindow& window, const Settings& settings) {
  const PreparationOptions& options = settings.preparation;
  Result<PreparationData> data = read_preparation_data(options);
  if (!data) return data.error();
  Result<std::optional<ObservationSet>> companions = read_companions(options, settings.input);
  if (!companions) return companions.error();
  data->companions = std::move(*companions);
  for (const WindowFile& file : files) data->file_names.push_back(file.name);
  return prepare(all, window, options, *data);
}

// What was chosen of these observations (ascending), by their places among them.
std::pair<Retained, std::vector<Retained>> chosen_among(std::span<const std::uint32_t> part,
                                                        const WindowOutcome& outcome) {
  constexpr std::uint32_t elsewhere = 0xffffffff;
  std::vector<std::uint32_t> place(outcome.prepared.observations.size(), elsewhere);
  for (std::uint32_t i = 0; i < part.size(); ++i) place[part[i]] = i;
  std::pair<Retained, std::vector<Retained>> chosen;
  for (std::size_t i = 0; i < outcome.retained.size(); ++i) {
    if (place[outcome.retained[i]] == elsewhere) continue;
    chosen.first.push_back(place[outcome.retained[i]]);
    if (outcome.members.empty()) continue;
    Retained members = outcome.members[i];
    for (std::uint32_t& member : members) member = place[member];
    chosen.second.push_back(std::move(members));
  }
  return chosen;
}

Result<void> evaluate_each_instrument(double bandwidth_km, WindowOutcome& outcome) {
  return each_instrument(
      outcome.prepared.observations,
      [&](Instrument instrument, const ObservationSet& part, std::span<const std::uint32_t> members) -> Result<void> {
        const auto [retained, merged] = chosen_among(members, outcome);
        Result<ThinnedError> error = thinned_error(part, retained, merged, bandwidth_km);
        if (!error) return error.error();
        outcome.errors.emplace(instrument, std::move(*error));
        return {};
      });
}

// Messages of other kinds leave with the window that holds the file's earliest observation, so that a file which spans
// several windows hands them on once.
bool carries_other_messages(const ObservationSet& observations, const TimeWindow& window) {
  const auto earliest = std::min_element(observations.time_ms.begin(), observations.time_ms.end());
  return earliest != observations.time_ms.end() && window.holds(*earliest);
}

Result<FileOutcome> write_file(const WindowFile& file, const std::vector<SourceReference>& retained,
                               const TimeWindow& window, OutputOptions options, const std::string& directory) {
  const ObservationSet& observations = file.contents.observations;
  FileOutcome outcome = outcome_without_output(file, window);
  outcome.retained = retained.size();
  // With flags, a file of which nothing is retained goes out with all of it flagged.
  const bool all_flagged = options.mode == OutputOptions::Mode::flag && outcome.observations > 0;
  if (retained.empty() && !all_flagged) return outcome;
  if (!carries_other_messages(observations, window)) options.other_messages = OutputOptions::OtherMessages::drop;

  const std::string path = directory + "/" + file.name;
  const std::string temporary = directory + "/." + file.name + ".tmp";
  Result<ExtractionSummary> summary = extract_observations(file.original_path, retained, temporary, options);
  if (!summary) return summary.error();
  outcome.output = *summary;
  if (Result<void> placed = publish_file(temporary, path); !placed) return placed.error();
  return outcome;
}

// The outcome of each file, in the order of the files, with the outputs extracted from them.
Result<void> extract_retained(const std::vector<WindowFile>& files, const Settings& settings,
                              const std::string& directory, WindowOutcome& outcome) {
  std::vector<std::vector<SourceReference>> retained(files.size());
  for (const std::uint32_t i : outcome.retained) {
    const SourceReference& source = outcome.prepared.observations.source[i];
    retained[source.file].push_back(source);
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    Result<FileOutcome> written = write_file(files[i], retained[i], outcome.window, settings.output, directory);
    if (!written) return written.error();
    outcome.files.push_back(std::move(*written));
  }
  return {};
}

Result<void> write_outputs(const std::vector<WindowFile>& files, const ObservationSet& all, const Settings& settings,
                           const std::string& directory, WindowOutcome& outcome) {
  Result<void> written = settings.thinner->makes_observations() ? write_superobs(files, all, directory, outcome)
                                                                : extract_retained(files, settings, directory, outcome);
  if (!written) return written;
  return write_text_atomically(directory + "/" + kReportName, report_json(outcome, settings));
}

}  // namespace

FileOutcome outcome_without_output(const WindowFile& file, const TimeWindow& window) {
  FileOutcome outcome;
  outcome.name = file.name;
  outcome.layout = file.contents.layout;
  outcome.instrument = file.contents.instrument;
  outcome.read = file.contents.observations.size();
  outcome.skipped = file.contents.skipped;
  outcome.notes = file.contents.notes;
  const std::vector<std::int64_t>& times_ms = file.contents.observations.time_ms;
  outcome.observations = static_cast<std::size_t>(
      std::count_if(times_ms.begin(), times_ms.end(), [&](std::int64_t time_ms) { return window.holds(time_ms); }));
  return outcome;
}

Result<WindowOutcome> thin_window(std::vector<WindowFile> files, std::vector<RefusedFile> refused,
                                  const TimeWindow& window, const Settings& settings,
                                  const std::string& output_directory) {
  const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
  std::sort(files.begin(), files.end(), by_name);
  std::sort(refused.begin(), refused.end(), by_name);

  WindowOutcome outcome;
  outcome.window = window;
  outcome.refused = std::move(refused);
  StepClock clock(outcome.seconds);

  const ObservationSet all = merged(files);
  Result<Prepared> prepared = prepare_files(files, all, window, settings);
  if (!prepared) return prepared.error();
  outcome.prepared = std::move(*prepared);
  if (outcome.prepared.observations.size() == 0)
    return nothing_left(outcome.prepared, all, settings.preparation.screening);
  clock.finish("prepare");

  Result<Choice> choice = settings.thinner->thin(outcome.prepared.observations);
  if (!choice) return choice.error();
  outcome.retained = std::move(choice->retained);
  outcome.members = std::move(choice->members);
  for (std::string& note : choice->notes) outcome.prepared.notes.push_back(std::move(note));
  for (const std::uint32_t i : outcome.retained)
    ++outcome.retained_by_sounder[sounder_of(outcome.prepared.observations, i)];
  clock.finish("thin");

  const double bandwidth_km = choice->bandwidth_km.value_or(kReportBandwidthKm);
  if (Result<void> evaluated = evaluate_each_instrument(bandwidth_km, outcome); !evaluated) return evaluated.error();
  clock.finish("evaluate");

  if (Result<void> written = write_outputs(files, all, settings, output_directory, outcome); !written)
    return written.error();
  clock.finish("write");
  return outcome;
}

}  // namespace thin
