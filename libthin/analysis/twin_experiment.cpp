#include "libthin/analysis/twin_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libthin/analysis/gaussian_field.h"
#include "libthin/analysis/optimal_interpolation.h"
#include "libthin/estimation/gme_grid.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

constexpr int kTargetLevel = 6;
constexpr double kTolerance = 1e-5;  // of the interpolation
constexpr double kTargetReachKm = 100;
constexpr double kActivityLengthKm = 1200;
constexpr double kCommonVariance = 0.5;               // of the background errors of several channels
constexpr std::int64_t kBetweenCasesMs = 17'340'000;  // 4 h 49 min: another part of the orbits

std::vector<Vector3> targets_near(const ObservationSet& places) {
  std::vector<Vector3> targets;
  const KdTree tree(places_at(places.position_km).coordinates, 3);
  std::vector<Neighbour> found;
  for (const Vector3& vertex : gme_grid(kTargetLevel)) {
    const double coordinates[] = {vertex.x, vertex.y, vertex.z};
    tree.nearest(coordinates, 1, found);
    if (!found.empty() && found.front().distance_squared <= kTargetReachKm * kTargetReachKm) targets.push_back(vertex);
  }
  return targets;
}

// s(x) g(x), places x channels.
std::vector<double> background_errors(std::span<const Vector3> places, const TwinOptions& options, std::uint64_t seed) {
  const auto channels = static_cast<std::size_t>(options.observations.channels);
  const std::vector<double> height = GaussianField(seed + 1, kActivityLengthKm).at(places);
  const std::vector<double> common = GaussianField(seed + 2, options.background_length_km).at(places);
  std::vector<double> errors(places.size() * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<double> own = GaussianField(seed + 3 + c, options.background_length_km).at(places);
    const double shared = channels == 1 ? 0 : kCommonVariance;
    for (std::size_t i = 0; i < places.size(); ++i) {
      // Uniform in 0..1 over the Earth; the mean of 3 a² is 1.
      const double activity = 0.5 * std::erfc(-height[i] / std::sqrt(2.0));
      const double variance = 1 - options.flow_dependence + options.flow_dependence * 3 * activity * activity;
      errors[i * channels + c] = options.background_error_k * std::sqrt(variance) *
                                 (std::sqrt(shared) * common[i] + std::sqrt(1 - shared) * own[i]);
    }
  }
  return errors;
}

double mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

// Innovations, innovations with fresh errors, errors: as channels of one set, so that means can be taken of all.
ObservationSet side_by_side(const TwinCase& made) {
  const std::size_t n = made.innovations.size(), channels = made.innovations.channel_count();
  ObservationSet all = made.innovations;
  all.values.clear();
  for (std::size_t i = 0; i < n; ++i)
    for (const std::vector<double>* part : {&made.innovations.values, &made.fresh_k, &made.errors.errors_k})
      for (std::size_t c = 0; c < channels; ++c) all.values.push_back((*part)[i * channels + c]);
  all.channels.resize(3 * channels);
  std::iota(all.channels.begin(), all.channels.end(), 1);
  return all;
}

std::vector<double> columns(const ObservationSet& set, std::size_t first, std::size_t count) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), first);
  return set.select_channels(places).values;
}

class Scorer {
 public:
  Scorer(const TwinOptions& options, const TwinCase& twin_case)
      : options_(options), case_(twin_case), all_(side_by_side(twin_case)) {
    for (const double factor : options.error_factors)
      ratios_.push_back(factor * options.observations.total_error_k() / options.background_error_k);
  }

  void add(TwinScore& score, const Choice& choice) const {
    const std::size_t channels = case_.innovations.channel_count();
    const ObservationSet chosen = chosen_observations(all_, choice);
    const std::vector<double> values = columns(chosen, 0, 2 * channels),
                              errors = columns(chosen, 2 * channels, channels);
    double outliers = 0;
    for (const std::uint32_t i : choice.retained) outliers += case_.errors.is_outlier[i];
    const OptimalInterpolation interpolation(chosen.position_km, case_.targets, options_.length_km());
    const auto increments = interpolation.estimates(values, 2 * channels, ratios_, kTolerance);
    score.mean_squared_k2.resize(ratios_.size());
    score.with_fresh_errors.resize(ratios_.size());
    for (std::size_t f = 0; f < ratios_.size(); ++f) {
      double squares[2] = {};
      for (std::size_t i = 0; i < case_.background_error_k.size(); ++i)
        for (std::size_t kind = 0; kind < 2; ++kind) {
          const std::size_t at = i / channels * 2 * channels + kind * channels + i % channels;
          squares[kind] += std::pow(case_.background_error_k[i] + increments[f][at], 2);
        }
      const auto count = static_cast<double>(case_.background_error_k.size());
      score.mean_squared_k2[f].push_back(squares[0] / count);
      score.with_fresh_errors[f].push_back(squares[1] / count);
    }
    score.retained.push_back(static_cast<double>(choice.retained.size()));
    score.retained_error_k.push_back(std::sqrt(mean_square(errors)));
    score.outlier_share.push_back(outliers / static_cast<double>(std::max<std::size_t>(choice.retained.size(), 1)));
  }

 private:
  const TwinOptions& options_;
  const TwinCase& case_;
  const ObservationSet all_;
  std::vector<double> ratios_;
};

std::vector<TwinScore> empty_scores(const std::vector<Variant>& variants, const TwinOptions& options) {
  std::vector<TwinScore> scores;
  const auto add = [&](const std::string& label, std::optional<std::size_t> variant,
                       std::optional<std::int64_t> asked) {
    TwinScore score;
    score.label = label, score.variant = variant, score.asked = asked;
    scores.push_back(std::move(score));
  };
  add("background", std::nullopt, 0);
  add("all", std::nullopt, std::nullopt);
  for (const char* label : {"farthest_point", "random"})
    for (const int count : options.counts) add(label, std::nullopt, count);
  for (std::size_t v = 0; v < variants.size(); ++v)
    for (const auto& asked : numbers_for(variants[v], options.counts)) add(variants[v].label, v, asked);
  return scores;
}

std::uint64_t case_seed(const TwinOptions& options, int number) {
  return (static_cast<std::uint64_t>(options.seed) * 1'000U + static_cast<std::uint64_t>(number)) * 1'000U;
}

}  // namespace

void TwinOptions::declare(OptionTable& table) {
  observations.declare(table);
  table.add("methods", methods, {.explanation = "as in [evaluate]"});
  table.add("counts", counts, {.unit = "observations", .minimum = 1, .explanation = "how many to retain"});
  table.add("cases", cases, {.minimum = 1, .maximum = 1000, .explanation = "times, each with its own errors"});
  table.add("seed", seed, {.minimum = 0, .maximum = 1e6, .explanation = "of all errors"});
  table.add("background_error_k", background_error_k, {.unit = "K", .above = 0, .explanation = "standard deviation"});
  table.add("background_length_km", background_length_km,
            {.unit = "km", .above = 0, .explanation = "L of its correlation exp(-d²/2L²)"});
  table.add("flow_dependence", flow_dependence,
            {.minimum = 0,
             .maximum = 1,
             .explanation = "share of the background error's variance that is in active regions alone"});
  table.add("assimilation_length_km", assimilation_length_km,
            {.unit = "km", .above = 0, .explanation = "what the assimilation takes for L; unset: the right one"});
  table.add("error_factors", error_factors,
            {.above = 0,
             .explanation = "of the observation error in the assimilation, over the right one; the best is found "
                            "for each method on the other cases"});
}

Result<TwinCase> twin_case(const TwinOptions& options, int number) {
  const auto begin_ms = from_iso8601(options.observations.begin);
  if (!begin_ms)
    return Error{ErrorKind::configuration, fmt::format("begin = \"{}\" is no time; write it as 2004-07-21T22:30:00Z",
                                                       options.observations.begin)};
  Result<ObservationSet> places = twin_places(options.observations, *begin_ms + number * kBetweenCasesMs);
  if (!places) return places.error();
  const std::uint64_t seed = case_seed(options, number);
  TwinCase made;
  made.innovations = std::move(*places);
  if (made.innovations.size() == 0)
    return Error{ErrorKind::input,
                 fmt::format("case {}: the satellites see land alone; choose a longer window_minutes or another begin",
                             number + 1)};
  made.targets = targets_near(made.innovations);
  made.background_error_k = background_errors(made.targets, options, seed);
  made.errors = twin_errors(made.innovations, options.observations, seed + 500);
  made.fresh_k = twin_errors(made.innovations, options.observations, seed + 700).errors_k;
  const std::vector<double> background = background_errors(made.innovations.position_km, options, seed);
  for (std::size_t i = 0; i < background.size(); ++i) {
    made.innovations.values[i] = made.errors.errors_k[i] - background[i];
    made.fresh_k[i] -= background[i];
  }
  return made;
}

Result<Twin> twin_experiment(const std::vector<Variant>& variants, const TwinOptions& options,
                             const std::function<void(const std::string&)>& progress) {
  Twin twin;
  twin.scores = empty_scores(variants, options);
  for (int number = 0; number < options.cases; ++number) {
    const Result<TwinCase> made = twin_case(options, number);
    if (!made) return made.error();
    progress(fmt::format("case {} of {}: {} observations", number + 1, options.cases, made->innovations.size()));
    twin.observations.push_back(static_cast<double>(made->innovations.size()));
    const Scorer scorer(options, *made);
    for (TwinScore& score : twin.scores) {
      const Result<Choice> choice = choose_set(score.variant ? &variants[*score.variant] : nullptr, score.label,
                                               made->innovations, score.asked, case_seed(options, number) + 900);
      if (!choice && score.variant) {
        const auto same = [&](const auto& failure) { return failure.variant == *score.variant; };
        if (std::none_of(twin.failures.begin(), twin.failures.end(), same))
          twin.failures.push_back({*score.variant, choice.error().message});
      }
      if (choice) scorer.add(score, *choice);
    }
  }
  const auto failed = [&](const TwinScore& score) {
    return score.retained.size() != static_cast<std::size_t>(options.cases);
  };
  std::erase_if(twin.scores, failed);
  return twin;
}

std::vector<double> nominal_errors(const TwinScore& score, const TwinScore& background, const TwinOptions& options) {
  std::size_t nominal = 0;
  const auto& factors = options.error_factors;
  for (std::size_t f = 1; f < factors.size(); ++f)
    if (std::abs(std::log(factors[f])) < std::abs(std::log(factors[nominal]))) nominal = f;
  std::vector<double> errors;
  for (std::size_t i = 0; i < score.retained.size(); ++i)
    errors.push_back(std::sqrt(score.mean_squared_k2[nominal][i] / background.mean_squared_k2[0][i]));
  return errors;
}

std::vector<std::size_t> tuned_factors(const TwinScore& score) {
  std::vector<std::size_t> factors;
  for (std::size_t i = 0; i < score.retained.size(); ++i) {
    std::size_t best = 0;
    double least = 0;
    for (std::size_t f = 0; f < score.mean_squared_k2.size(); ++f) {
      const auto& errors = score.mean_squared_k2[f];
      const double others = std::accumulate(errors.begin(), errors.end(), 0.0) - (errors.size() > 1 ? errors[i] : 0);
      if (f == 0 || others < least) best = f, least = others;
    }
    factors.push_back(best);
  }
  return factors;
}

std::vector<double> tuned_errors(const TwinScore& score, const TwinScore& background) {
  const std::vector<std::size_t> factors = tuned_factors(score);
  std::vector<double> errors;
  for (std::size_t i = 0; i < factors.size(); ++i)
    errors.push_back(std::sqrt(score.mean_squared_k2[factors[i]][i] / background.mean_squared_k2[0][i]));
  return errors;
}

}  // namespace thin
