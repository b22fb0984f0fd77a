#include "libthin/analysis/evaluation.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "libthin/analysis/signal_free.h"
#include "libthin/analysis/synthetic_innovations.h"
#include "libthin/estimation/gme_grid.h"
#include "libthin/foundation/memory.h"

namespace thin {
namespace {

using Progress = std::function<void(const std::string&)>;

double process_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// Thins `repetitions` times; all give the same.
Result<Choice> timed_choice(const Thinner& thinner, const ObservationSet& set, int repetitions, Cost& cost) {
  using Clock = std::chrono::steady_clock;
  for (int repetition = 1;; ++repetition) {
    const PeakMemory memory;
    const double cpu_began = process_cpu_seconds();
    const auto began = Clock::now();
    Result<Choice> choice = thinner.thin(set);
    cost.seconds.push_back(std::chrono::duration<double>(Clock::now() - began).count());
    cost.cpu_seconds.push_back(process_cpu_seconds() - cpu_began);
    if (repetition == 1) cost.peak_memory_bytes = memory.bytes_above_start();
    if (!choice || repetition >= repetitions) return choice;
  }
}

// One point of a variant's curve.
Result<void> thin_to(const ObservationSet& set, const Variant& variant, std::optional<std::int64_t> asked,
                     int repetitions, Evaluated& result, Cost& cost) {
  result.asked = asked;
  Result<std::optional<double>> fitted = aim_at(variant, set, asked);
  if (!fitted) return fitted.error();
  result.fitted_value = *fitted;
  Result<Choice> choice = timed_choice(*variant.thinner, set, repetitions, cost);
  if (!choice) return choice.error();
  result.retained = std::move(choice->retained);
  result.members = std::move(choice->members);
  result.notes = std::move(choice->notes);
  return {};
}

void thin_all(const ObservationSet& set, const std::vector<Variant>& variants, const EvaluationOptions& options,
              const Progress& progress, Evaluation& evaluation) {
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const Variant& variant = variants[v];
    for (const auto& asked : numbers_for(variant, options.counts)) {
      progress(asked ? fmt::format("{}: to {}", variant.label, *asked) : variant.label);
      Evaluated result;
      Cost cost;
      result.variant = v;
      if (const Result<void> thinned = thin_to(set, variant, asked, options.repetitions, result, cost); !thinned) {
        evaluation.failures.push_back({v, thinned.error().message});
        break;
      }
      evaluation.results.push_back(std::move(result));
      evaluation.costs.push_back(std::move(cost));
    }
  }
}

Result<void> add_errors(const ObservationSet& set, const EvaluationOptions& options, Evaluation& evaluation) {
  std::vector<Retained> thinned;
  for (const Evaluated& result : evaluation.results) thinned.push_back(result.retained);
  const CommonErrorOptions common{.bandwidth_km = options.bandwidth_km, .level = options.level};
  auto errors = common_errors(set, thinned, common);
  if (!errors) return errors.error();
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    Evaluated& result = evaluation.results[i];
    result.error = std::move((*errors)[i]);
    if (!result.members.empty()) {
      auto of_means = common_error_of_means(set, result.members, common);
      if (!of_means) return of_means.error();
      result.error = std::move(*of_means);
    }
    result.signal_to_noise_observations_db =
        signal_to_noise_db(evaluation.mean_absolute_value_k, result.error.at_observations.mean_squared_k2);
    result.signal_to_noise_grid_db =
        signal_to_noise_db(evaluation.mean_absolute_value_k, result.error.on_grid.mean_squared_k2);
  }
  return {};
}

Result<void> add_signal_free_shares(const ObservationSet& set, const EvaluationOptions& options,
                                    Evaluation& evaluation) {
  Retained all(set.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto flags = signal_free(set, {.bandwidth_km = options.bandwidth_km, .noise_factor = options.noise_factor});
  if (!flags) return flags.error();
  evaluation.signal_free_share = share_of(*flags, all);
  for (Evaluated& result : evaluation.results) result.signal_free_share = share_of(*flags, result.retained);

  const auto truth = set.variables.find(kSignalFree);
  if (truth == set.variables.end()) return {};
  const std::vector<std::uint8_t> true_flags(truth->second.begin(), truth->second.end());
  evaluation.true_signal_free_share = share_of(true_flags, all);
  for (Evaluated& result : evaluation.results) result.true_signal_free_share = share_of(true_flags, result.retained);
  return {};
}

// Against the reference's set of the same number asked for, or its only one.
void add_density_differences(const ObservationSet& set, const std::vector<Variant>& variants,
                             const EvaluationOptions& options, Evaluation& evaluation) {
  const auto reference_of = [&](const Evaluated& result) -> const Evaluated* {
    for (const Evaluated& other : evaluation.results)
      if (variants[other.variant].label == options.reference && (!other.asked || other.asked == result.asked))
        return &other;
    return nullptr;
  };
  for (Evaluated& result : evaluation.results)
    if (const Evaluated* reference = reference_of(result); reference && reference->variant != result.variant)
      result.boxes = density_difference(set, result.retained, reference->retained, options.box_km);
}

}  // namespace

void EvaluationOptions::declare(OptionTable& table) {
  table.add("methods", methods,
            {.explanation = "to compare, each with its defaults, beside the variants that [[evaluate.variant]] "
                            "describes; empty: where there are no variants, all that there are"});
  table.add(
      "counts", counts,
      {.unit = "observations",
       .minimum = 1,
       .explanation = "how many to retain; for methods that can't be told a number, their mesh or step is fitted"});
  table.add("bandwidth_km", bandwidth_km,
            {.unit = "km",
             .maximum = 5000,
             .above = 0,
             .explanation = "h of the common estimate that all sets are measured with; and of every variant that has "
                            "one and does not say otherwise"});
  table.add("level", level,
            {.minimum = 0, .maximum = kMaximumGmeLevel, .explanation = "of the GME grid that the error is taken on"});
  table.add("repetitions", repetitions,
            {.minimum = 1, .maximum = 1000, .explanation = "of each thinning, for the median of its seconds"});
  table.add("reference", reference, {.explanation = "label of the variant that densities are compared with"});
  table.add("box_km", box_km,
            {.unit = "km", .minimum = 1, .maximum = 5000, .explanation = "side of the boxes for that"});
  table.add("noise_factor", noise_factor,
            {.minimum = 0,
             .maximum = 1000,
             .explanation = "an area is free of signal where the full set's estimate varies no more within 3h than so "
                            "many times what noise alone would make of it"});
  table.add("errors", errors, {.explanation = "false: costs, separations and densities alone; for large sets"});
  table.add("list_boxes", list_boxes, {.explanation = "write the density difference of every box into the JSON"});
  table.add("list_retained", list_retained, {.explanation = "write every set that is retained into the JSON"});
}

Result<Evaluation> evaluate(const ObservationSet& set, const std::vector<Variant>& variants,
                            const EvaluationOptions& options, const Progress& progress) {
  Evaluation evaluation;
  evaluation.mean_absolute_value_k = mean_absolute_value_k(set);
  thin_all(set, variants, options, progress, evaluation);
  for (Evaluated& result : evaluation.results) result.separation = separation_statistics(set, result.retained);
  add_density_differences(set, variants, options, evaluation);
  if (options.errors) {
    progress("errors at the observations and on the grid");
    if (Result<void> added = add_errors(set, options, evaluation); !added) return added.error();
    progress("areas free of signal");
    if (Result<void> added = add_signal_free_shares(set, options, evaluation); !added) return added.error();
  }
  return evaluation;
}

}  // namespace thin
