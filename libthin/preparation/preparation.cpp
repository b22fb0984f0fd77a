#include "libthin/preparation/preparation.h"

#include <fmt/format.h>

namespace thin {
namespace {

// The observations that are still in the run, with what becomes of the others written down.
class Run {
 public:
  Run(const ObservationSet& all, const TimeWindow& window) {
    std::vector<std::uint32_t> in_window;
    for (const std::uint32_t i : canonical_order(all)) {
      if (window.holds(all.time_ms[i]))
        in_window.push_back(i);
      else
        ++prepared.outside_window;
    }
    set = all.select(in_window);
    prepared.origin = std::move(in_window);
    for (std::size_t i = 0; i < set.size(); ++i) ++prepared.sounders[sounder_of(set, i)].observations;
  }

  // Goes on with the observations for which leaves(i, its sounder's tally), which counts it there, is false.
  template <class Leaves>
  void drop(const Leaves& leaves) {
    std::vector<std::uint32_t> staying, origin;
    for (std::uint32_t i = 0; i < set.size(); ++i) {
      if (leaves(i, prepared.sounders[sounder_of(set, i)])) continue;
      staying.push_back(i);
      origin.push_back(prepared.origin[i]);
    }
    if (staying.size() == set.size()) return;
    set = set.select(staying);
    prepared.origin = std::move(origin);
  }

  ObservationSet set;
  Prepared prepared;
};

void drop_duplicates(Run& run, const PreparationOptions& options, const PreparationData& data) {
  const std::vector<Duplicate> duplicates = find_duplicates(run.set, data.file_names, options.duplicates);
  run.drop([&](std::uint32_t i, SounderTally& tally) {
    tally.near_duplicates += duplicates[i] == Duplicate::near;
    tally.exact_duplicates += duplicates[i] == Duplicate::exact;
    return duplicates[i] != Duplicate::none;
  });
}

bool count_reason(ScreeningReason reason, SounderTally& tally) {
  if (reason != ScreeningReason::none) ++tally.screened[reason];
  return reason != ScreeningReason::none;
}

void note_screening(const Screening& screening, const ScreeningOptions& options, std::vector<std::string>& notes) {
  for (const DeadChannel& dead : screening.dead) {
    const bool named = !options.channels.empty() || options.channels_of.contains(dead.instrument);
    notes.push_back(fmt::format("channel {} is missing in {} of {} observations of {}{}", dead.channel, dead.missing,
                                dead.observations, sounder_name({dead.platform, dead.instrument}),
                                named ? "" : ": it is not used in this window"));
  }
  for (const std::string& variable : screening.absent)
    notes.push_back(fmt::format("no observation has the variable {} that [preparation] screens by", variable));
}

Result<void> screen_out(Run& run, const PreparationOptions& options, const PreparationData& data) {
  if (data.shoreline && !options.screening.surfaces.empty())
    run.prepared.surfaces_filled = fill_surfaces(run.set, *data.shoreline, options.surface.coast_distance_km);
  Result<Screening> screening = screen(run.set, options.screening);
  if (!screening) return screening.error();
  run.drop([&](std::uint32_t i, SounderTally& tally) { return count_reason(screening->reasons[i], tally); });
  run.set = run.set.select_channels(screening->channel_places);
  note_screening(*screening, options.screening, run.prepared.notes);
  run.prepared.dead_channels = std::move(screening->dead);
  return {};
}

template <class T>
const T* pointer(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

void correct_and_subtract(Run& run, const PreparationOptions& options, const PreparationData& data) {
  const FirstGuess choice = options.first_guess.first_guess;
  const bool from_companions = choice == FirstGuess::companion && run.set.value_kind != ValueKind::innovation;
  if (from_companions) take_companions(run.set, data.companions.value_or(ObservationSet()), options.companions);
  std::vector<GuessSource> sources = first_guess_sources(run.set, choice);

  std::vector<bool> has_own(run.set.size()), uncorrected;
  for (std::size_t i = 0; i < sources.size(); ++i) has_own[i] = sources[i] == GuessSource::given && !from_companions;
  run.prepared.bias =
      correct_bias(run.set, pointer(data.bias_table), pointer(data.bias_predictors), has_own, uncorrected);

  std::vector<GuessSource> staying;
  run.drop([&](std::uint32_t i, SounderTally& tally) {
    ScreeningReason reason = ScreeningReason::none;
    if (uncorrected[i] && options.bias.uncorrected == BiasOptions::Uncorrected::screen)
      reason = ScreeningReason::no_bias_correction;
    else if (sources[i] == GuessSource::missing)
      reason = from_companions ? ScreeningReason::no_companion : ScreeningReason::no_first_guess;
    if (reason == ScreeningReason::none) staying.push_back(sources[i]);
    return count_reason(reason, tally);
  });
  run.prepared.first_guess = subtract_first_guess(run.set, staying, options.first_guess, run.prepared.notes);
}

}  // namespace

void PreparationOptions::declare(OptionTable& table) {
  duplicates.declare(table);
  screening.declare(table);
  surface.declare(table);
  bias.declare(table);
  first_guess.declare(table);
  companions.declare(table);
}

std::optional<PreparationOptions::Conflict> PreparationOptions::conflict() const {
  if (first_guess.first_guess == FirstGuess::companion && companions.files.empty())
    return Conflict{"first_guess", "= \"companion\" needs companion_files: name the files that hold the first guess"};
  if (first_guess.first_guess != FirstGuess::companion && !companions.files.empty())
    return Conflict{"companion_files", "is used by first_guess = \"companion\" alone: set that, or leave this out"};
  if (screening.minimum_latitude_deg > screening.maximum_latitude_deg)
    return Conflict{"minimum_latitude_deg",
                    fmt::format("must not lie north of maximum_latitude_deg = {:g}, as {:g} does",
                                screening.maximum_latitude_deg, screening.minimum_latitude_deg)};
  if (screening.minimum_k && screening.maximum_k && *screening.minimum_k > *screening.maximum_k)
    return Conflict{"minimum_k", fmt::format("must be at most maximum_k = {:g}, not {:g}", *screening.maximum_k,
                                             *screening.minimum_k)};
  return std::nullopt;
}

Result<Prepared> prepare(const ObservationSet& observations, const TimeWindow& window,
                         const PreparationOptions& options, const PreparationData& data) {
  Run run(observations, window);
  drop_duplicates(run, options, data);
  if (Result<void> screened = screen_out(run, options, data); !screened) return screened.error();
  correct_and_subtract(run, options, data);
  for (std::size_t i = 0; i < run.set.size(); ++i) ++run.prepared.sounders[sounder_of(run.set, i)].prepared;
  run.prepared.observations = std::move(run.set);
  return std::move(run.prepared);
}

}  // namespace thin
