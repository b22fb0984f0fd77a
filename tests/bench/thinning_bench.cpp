// The methods on the thesis's scale: 27,367 observations to 3,000, h = 100 km, level 6, eight channels, one thread.
// The thesis (table 6.1, 2.8 GHz Pentium 4 era): Grid EEA 63 s with full updating, 0.78 s with lazy.

#include <benchmark/benchmark.h>

#include "libthin/estimation/gme_grid.h"
#include "libthin/foundation/parallel.h"
#include "libthin/thinning/greedy_removal.h"
#include "tests/support/synthetic_soundings.h"

namespace thin {
namespace {

constexpr std::size_t kObservations = 27367;

const ObservationSet& soundings(std::size_t count) {
  static std::map<std::size_t, ObservationSet> sets;
  const auto [place, is_new] = sets.try_emplace(count);
  if (is_new) place->second = test::synthetic_innovations(count);
  return place->second;
}

void assign(const OptionTable& table, const std::string& name, const OptionValue& value) {
  if (const auto problem = table.find(name)->assign(value)) throw std::runtime_error(name + " " + *problem);
}

void thin_with(benchmark::State& state, const std::string& name,
               const std::vector<std::pair<std::string, OptionValue>>& options) {
  const ThreadLimit limit(1);
  const ObservationSet& set = soundings(static_cast<std::size_t>(state.range(0)));
  const auto method = find_thinning_method(name)->make();
  OptionTable table;
  method->declare_options(table);
  for (const auto& [option, value] : options) assign(table, option, value);
  std::size_t retained = 0;
  for (auto _ : state) {
    const Result<Retained> result = method->thin(set);
    retained = result->size();
  }
  state.counters["retained"] = static_cast<double>(retained);
}

void grid_eea(benchmark::State& state, const char* update) {
  const auto retain_count = static_cast<std::int64_t>(3000 * state.range(0) / static_cast<std::int64_t>(kObservations));
  thin_with(state, "grid_eea",
            {{"retain_count", retain_count},
             {"bandwidth_km", 100.0},
             {"level", std::int64_t{6}},
             {"update", std::string(update)}});
}

void neighbourhoods(benchmark::State& state) {
  const ThreadLimit limit(1);
  const ObservationSet& set = soundings(kObservations);
  const auto grid = gme_grid(6);
  for (auto _ : state) {
    const auto table = neighbourhood_table(grid, set.position_km, {100});
    state.counters["pairs"] = static_cast<double>(table->entry_count());
    state.counters["evaluation_points"] = static_cast<double>(table->evaluation_point_count());
  }
}

BENCHMARK_CAPTURE(grid_eea, full, "full")
    ->Arg(kObservations)
    ->Arg(2 * kObservations)
    ->Arg(4 * kObservations)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_eea, lazy, "lazy")->Arg(kObservations)->Unit(benchmark::kMillisecond);
BENCHMARK(neighbourhoods)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(thin_with, box, "box", {{"horizontal_mesh", 200.0}})
    ->Arg(kObservations)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(thin_with, stepwise, "stepwise", {{"step", std::int64_t{3}}})
    ->Arg(kObservations)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thin

BENCHMARK_MAIN();
