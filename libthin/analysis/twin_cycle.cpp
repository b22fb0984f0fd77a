#include "libthin/analysis/twin_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libthin/analysis/gaussian_field.h"
#include "libthin/analysis/optimal_interpolation.h"
#include "libthin/analysis/transport_model.h"
#include "libthin/estimation/variogram.h"
#include "libthin/observations/time.h"

namespace thin {
namespace {

using Fields = std::vector<std::vector<double>>;  // of each channel; of several sets one after another

constexpr double kStepHours = 2;
constexpr int kTruthSpinUpDays = 25;
constexpr double kPatternLengthKm = 1500;
constexpr double kPatternK = 8, kPoleToEquatorK = 40;
constexpr double kRelaxationHours = 20 * 24;
constexpr double kLeastBackgroundShare = 0.25;  // of the observation error

class CycledExperiment {
 public:
  CycledExperiment(const std::vector<Variant>& variants, const TwinObservationOptions& observations,
                   const TwinCycleOptions& options, int seed, std::int64_t begin_ms)
      : variants_(variants),
        observations_(observations),
        options_(options),
        seed_(static_cast<std::uint64_t>(seed) * 100'000U),
        begin_ms_(begin_ms),
        grid_(options.grid_deg),
        positions_km_(grid_.positions_km()),
        wind_(Wind::random(seed_ + 1)),
        forecast_wind_(wind_.with_errors(options.wind_error, seed_ + 2)) {
    observations_.window_minutes = options.hours * 60;
    observations_.step = options.observation_step;
    relaxation_.time_h = kRelaxationHours;
    for (int c = 0; c < observations_.channels; ++c) {
      const std::vector<double> pattern =
          GaussianField(seed_ + 11 + static_cast<std::uint64_t>(c), kPatternLengthKm).at(positions_km_);
      for (std::size_t i = 0; i < grid_.size(); ++i)
        relaxation_.equilibrium.push_back(kPatternK * pattern[i] -
                                          kPoleToEquatorK * std::pow(grid_.directions()[i].z, 2));
    }
  }

  Result<TwinCycles> run(const std::function<void(const std::string&)>& progress) {
    progress("truth");
    make_truth();
    TwinCycles result;
    result.sets = sets();
    result.truth_deviation_k = truth_deviation_k();
    // All begin with a truth of days before.
    Fields states;
    for (std::size_t s = 0; s < result.sets.size(); ++s)
      states.insert(states.end(), first_guess_.begin(), first_guess_.end());
    for (int cycle = 0; cycle < options_.cycles; ++cycle) {
      if (cycle % 4 == 0) progress(fmt::format("cycle {} of {}", cycle + 1, options_.cycles));
      if (Result<void> done = analyse(cycle, states, result); !done) return done.error();
      if (cycle >= options_.spin_up_cycles && (cycle - options_.spin_up_cycles) % options_.forecast_every == 0)
        forecast(cycle, states, result);
      carry(forecast_wind_, states, hour_of(cycle), options_.hours);
    }
    std::erase_if(result.sets, [](const CycledSet& set) { return set.failed; });
    return result;
  }

 private:
  std::size_t channels() const { return static_cast<std::size_t>(observations_.channels); }
  double hour_of(int cycle) const { return static_cast<double>(cycle * options_.hours); }

  void carry(const Wind& wind, Fields& fields, double time_h, double hours) const {
    const int steps = static_cast<int>(std::ceil(hours / kStepHours - 1e-9));
    for (int step = 0; step < steps; ++step)
      advance(grid_, wind, relaxation_, fields, time_h + step * hours / steps, hours / steps);
  }

  // Of every cycle, and as long after as forecasts reach.
  void make_truth() {
    Fields truth(channels());
    for (std::size_t c = 0; c < channels(); ++c)
      truth[c].assign(relaxation_.equilibrium.begin() + static_cast<std::ptrdiff_t>(c * grid_.size()),
                      relaxation_.equilibrium.begin() + static_cast<std::ptrdiff_t>((c + 1) * grid_.size()));
    carry(wind_, truth, -24.0 * kTruthSpinUpDays, 24.0 * (kTruthSpinUpDays - 3));
    first_guess_ = truth;
    carry(wind_, truth, -24.0 * 3, 24.0 * 3);
    const int last = options_.cycles + options_.forecast_days * 24 / options_.hours;
    mean_.assign(channels(), std::vector<double>(grid_.size(), 0));
    for (int cycle = 0; cycle <= last; ++cycle) {
      truth_.push_back(truth);
      for (std::size_t c = 0; c < channels(); ++c)
        for (std::size_t i = 0; i < grid_.size(); ++i) mean_[c][i] += truth[c][i] / (last + 1);
      carry(wind_, truth, hour_of(cycle), options_.hours);
    }
  }

  double truth_deviation_k() const {
    double sum = 0;
    for (const Fields& truth : truth_)
      for (std::size_t c = 0; c < channels(); ++c)
        for (std::size_t i = 0; i < grid_.size(); ++i) sum += grid_.area(i) * std::pow(truth[c][i] - mean_[c][i], 2);
    return std::sqrt(sum / static_cast<double>(truth_.size() * channels()));
  }

  std::vector<CycledSet> sets() const {
    std::vector<CycledSet> list;
    const auto add = [&](const std::string& label, std::optional<std::size_t> variant) {
      CycledSet set;
      set.label = label, set.variant = variant;
      set.northern.resize(static_cast<std::size_t>(options_.forecast_days) + 1);
      set.southern = set.global = set.northern;
      list.push_back(std::move(set));
    };
    for (const char* label : {"none", "all", "farthest_point", "random"}) add(label, std::nullopt);
    for (std::size_t v = 0; v < variants_.size(); ++v) add(variants_[v].label, v);
    return list;
  }

  double error_k(const Fields& states, std::size_t set, int cycle) const {
    double sum = 0;
    for (std::size_t c = 0; c < channels(); ++c)
      for (std::size_t i = 0; i < grid_.size(); ++i)
        sum += grid_.area(i) *
               std::pow(states[set * channels() + c][i] - truth_[static_cast<std::size_t>(cycle)][c][i], 2);
    return std::sqrt(sum / static_cast<double>(channels()));
  }

  Result<void> analyse(int cycle, Fields& states, TwinCycles& result) {
    const std::int64_t window_ms = std::int64_t{options_.hours} * 3'600'000;
    Result<ObservationSet> places = twin_places(observations_, begin_ms_ + cycle * window_ms);
    if (!places) return places.error();
    const TwinErrors errors =
        twin_errors(*places, observations_, seed_ + 1000 + static_cast<std::uint64_t>(cycle) * 10);
    Fields observed;
    for (std::size_t c = 0; c < channels(); ++c)
      observed.push_back(grid_.sample(truth_[static_cast<std::size_t>(cycle)][c], places->position_km));
    for (std::size_t s = 0; s < result.sets.size(); ++s) {
      CycledSet& set = result.sets[s];
      const double before = error_k(states, s, cycle);
      if (set.label != "none" && !set.failed) {
        ObservationSet innovations = *places;
        for (std::size_t c = 0; c < channels(); ++c) {
          const std::vector<double> background = grid_.sample(states[s * channels() + c], places->position_km);
          for (std::size_t i = 0; i < places->size(); ++i)
            innovations.values[i * channels() + c] =
                observed[c][i] + errors.errors_k[i * channels() + c] - background[i];
        }
        update(cycle, innovations, set, s, states, result);
      }
      if (cycle < options_.spin_up_cycles) continue;
      set.background_error_k.push_back(before);
      set.analysis_error_k.push_back(error_k(states, s, cycle));
    }
    return {};
  }

  void update(int cycle, const ObservationSet& innovations, CycledSet& set, std::size_t s, Fields& states,
              TwinCycles& result) const {
    const Result<Choice> choice =
        choose_set(set.variant ? &variants_[*set.variant] : nullptr, set.label, innovations,
                   set.label == "all" ? std::nullopt : std::optional<std::int64_t>(options_.count),
                   seed_ + 500 + static_cast<std::uint64_t>(cycle));
    if (!choice) {
      set.failed = true;
      if (set.variant) result.failures.push_back({*set.variant, choice.error().message});
      return;
    }
    const ObservationSet chosen = chosen_observations(innovations, *choice);
    const double error_k = observations_.total_error_k();
    double variance = 0;
    for (const double value : innovations.values)
      variance += value * value / static_cast<double>(innovations.values.size());
    const double background_k =
        std::sqrt(std::max(variance - error_k * error_k, std::pow(kLeastBackgroundShare * error_k, 2)));
    const OptimalInterpolation interpolation(chosen.position_km, positions_km_, options_.assimilation_length_km);
    const std::vector<double> increment =
        interpolation.estimate(chosen.values, channels(), options_.error_factor * error_k / background_k);
    for (std::size_t c = 0; c < channels(); ++c)
      for (std::size_t i = 0; i < grid_.size(); ++i) states[s * channels() + c][i] += increment[i * channels() + c];
    if (cycle < options_.spin_up_cycles) return;
    set.retained.push_back(static_cast<double>(choice->retained.size()));
    if (const auto fit = fitted_variogram(places_of(innovations), innovations.values, channels()))
      set.length_km.push_back(fit->correlation_length_km);
  }

  void forecast(int cycle, Fields states, TwinCycles& result) const {
    for (int day = 0; day <= options_.forecast_days; ++day) {
      if (day > 0) carry(forecast_wind_, states, hour_of(cycle) + 24.0 * (day - 1), 24);
      const auto at = static_cast<std::size_t>(cycle + day * 24 / options_.hours);
      for (std::size_t s = 0; s < result.sets.size(); ++s) {
        CycledSet& set = result.sets[s];
        const auto lead = static_cast<std::size_t>(day);
        set.northern[lead].push_back(correlation(states, s, at, 20, 90));
        set.southern[lead].push_back(correlation(states, s, at, -90, -20));
        set.global[lead].push_back(correlation(states, s, at, -90, 90));
      }
    }
  }

  // Centred, mean over the channels.
  double correlation(const Fields& states, std::size_t set, std::size_t at, double south_deg, double north_deg) const {
    double total = 0;
    for (std::size_t c = 0; c < channels(); ++c) {
      double area = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
      for (std::size_t i = 0; i < grid_.size(); ++i) {
        if (grid_.latitude_deg(i) < south_deg || grid_.latitude_deg(i) > north_deg) continue;
        const double a = grid_.area(i), f = states[set * channels() + c][i] - mean_[c][i],
                     t = truth_[at][c][i] - mean_[c][i];
        area += a, x += a * f, y += a * t, xx += a * f * f, yy += a * t * t, xy += a * f * t;
      }
      x /= area, y /= area;
      total += (xy / area - x * y) / std::sqrt((xx / area - x * x) * (yy / area - y * y));
    }
    return total / static_cast<double>(channels());
  }

  const std::vector<Variant>& variants_;
  TwinObservationOptions observations_;
  const TwinCycleOptions& options_;
  const std::uint64_t seed_;
  const std::int64_t begin_ms_;
  const GlobalGrid grid_;
  const std::vector<Vector3> positions_km_;
  const Wind wind_, forecast_wind_;
  Relaxation relaxation_;
  std::vector<Fields> truth_;  // at each cycle
  Fields first_guess_, mean_;
};

}  // namespace

void TwinCycleOptions::declare(OptionTable& table) {
  table.add("cycles", cycles, {.minimum = 0, .maximum = 10'000, .explanation = "of forecast and analysis; 0: none"});
  table.add("hours", hours, {.unit = "h", .minimum = 1, .maximum = 24, .explanation = "of a cycle; a divisor of 24"});
  table.add("spin_up_cycles", spin_up_cycles, {.minimum = 0, .explanation = "not counted in any figure"});
  table.add("count", count, {.unit = "observations", .minimum = 1, .explanation = "how many to retain each time"});
  table.add("observation_step", observation_step,
            {.minimum = 1, .maximum = 10, .explanation = "every so many fields of view and lines are observed"});
  table.add("grid_deg", grid_deg, {.unit = "degrees", .minimum = 0.5, .maximum = 15, .explanation = "of the model"});
  table.add("wind_error", wind_error,
            {.minimum = 0, .maximum = 1, .explanation = "of the forecast's wind: its strength and places"});
  table.add("assimilation_length_km", assimilation_length_km,
            {.unit = "km", .above = 0, .explanation = "L of the assimilation's background errors"});
  table.add("error_factor", error_factor,
            {.above = 0, .explanation = "of the observation error in the assimilation, over the right one"});
  table.add("forecast_days", forecast_days, {.minimum = 0, .maximum = 30, .explanation = "how long forecasts are"});
  table.add("forecast_every", forecast_every, {.minimum = 1, .explanation = "cycles a forecast starts"});
}

Result<TwinCycles> twin_cycles(const std::vector<Variant>& variants, const TwinObservationOptions& observations,
                               const TwinCycleOptions& options, int seed,
                               const std::function<void(const std::string&)>& progress) {
  const auto begin_ms = from_iso8601(observations.begin);
  if (!begin_ms)
    return Error{ErrorKind::configuration,
                 fmt::format("begin = \"{}\" is no time; write it as 2004-07-21T22:30:00Z", observations.begin)};
  if (24 % options.hours != 0 || std::abs(std::remainder(180, options.grid_deg)) > 1e-9)
    return Error{ErrorKind::configuration, "[cycle] hours must divide 24, and grid_deg 180"};
  return CycledExperiment(variants, observations, options, seed, *begin_ms).run(progress);
}

}  // namespace thin
