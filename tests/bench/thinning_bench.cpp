// The methods on the thesis's scale: 27,367 observations to 3,000, h = 100 km, level 6, eight channels, one thread.
// The thesis (table 6.1, 2.8 GHz Pentium 4 era): EEA 110 s with full updating, 4.3 s with lazy; Grid EEA 63 s and 0.78
// s.

#include <benchmark/benchmark.h>

#include "libthin/estimation/gme_grid.h"
#include "libthin/estimation/neighbourhood_table.h"
#include "libthin/foundation/memory.h"
#include "libthin/foundation/parallel.h"
#include "libthin/thinning/thinner.h"
#include "tests/support/random_observations.h"
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
  Thinner thinner(*find_thinning_method(name));
  OptionTable table;
  thinner.declare_options(table);
  for (const auto& [option, value] : options) assign(table, option, value);
  std::size_t retained = 0;
  for (auto _ : state) {
    const Result<Choice> choice = thinner.thin(set);
    retained = choice->retained.size();
  }
  state.counters["retained"] = static_cast<double>(retained);
}

void eea(benchmark::State& state, const char* method, const char* update) {
  const auto retain_count = static_cast<std::int64_t>(3000 * state.range(0) / static_cast<std::int64_t>(kObservations));
  thin_with(state, method, {{"retain_count", retain_count}, {"bandwidth_km", 100.0}, {"update", std::string(update)}});
}

void neighbourhoods(benchmark::State& state) {
  const ThreadLimit limit(1);
  const ObservationSet& set = soundings(kObservations);
  const Places places = places_of(set), points = evaluation_places(gme_grid(6), places, 100);
  for (auto _ : state) {
    const auto table = neighbourhood_table(points, places, {100});
    state.counters["pairs"] = static_cast<double>(table->entry_count());
    state.counters["evaluation_points"] = static_cast<double>(table->evaluation_point_count());
  }
}

#define EEA_BENCHMARKS(method)                                                                               \
  BENCHMARK_CAPTURE(eea, method##_full, #method, "full")->Arg(kObservations)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(eea, method##_lazy, #method, "lazy")->Arg(kObservations)->Unit(benchmark::kMillisecond)
EEA_BENCHMARKS(eea);
EEA_BENCHMARKS(grid_eea);
EEA_BENCHMARKS(top_down_eea);
EEA_BENCHMARKS(grid_top_down_eea);
BENCHMARK(neighbourhoods)->Unit(benchmark::kMillisecond);

// The other methods also on 100,000 observations.
#define METHOD_BENCHMARK(name, ...) \
  BENCHMARK_CAPTURE(thin_with, name, __VA_ARGS__)->Arg(kObservations)->Arg(100000)->Unit(benchmark::kMillisecond)
METHOD_BENCHMARK(top_down_clustering, "top_down_clustering", {{"retain_fraction", 3000.0 / kObservations}});
METHOD_BENCHMARK(box, "box", {{"horizontal_mesh", 200.0}});
METHOD_BENCHMARK(box_gme, "box", {{"grid", std::string("gme")}, {"level", std::int64_t{5}}});
METHOD_BENCHMARK(gaussian, "gaussian", {{"horizontal_mesh", 200.0}});
METHOD_BENCHMARK(poisson_disk, "poisson_disk", {{"min_horizontal_spacing", 150.0}});
METHOD_BENCHMARK(octree, "octree", {{"value_tolerance", 0.4}});
METHOD_BENCHMARK(stepwise, "stepwise", {{"step", std::int64_t{3}}});

METHOD_BENCHMARK(superob, "superob", {{"horizontal_mesh", 200.0}});
METHOD_BENCHMARK(analysis, "analysis", {{"retain_fraction", 3000.0 / kObservations}, {"correlation_length_km", 250.0}});

// An even cap of `count` observations of one channel, `spacing_km` apart, around a pole.
ObservationSet even_cap(std::size_t count, double spacing_km) {
  const double whole_km2 = 510.07e6;
  const ObservationSet globe =
      test::spiral_observations(static_cast<std::size_t>(whole_km2 / (spacing_km * spacing_km)), 1, 1);
  std::vector<std::uint32_t> cap(std::min(count, globe.size()));
  for (std::uint32_t i = 0; i < cap.size(); ++i) cap[i] = i;
  return globe.select(cap);
}

// Analysis thinning with L = 150 km; arguments: observations, spacing in km, retained, threads, exchange.
void analysis_on_a_cap(benchmark::State& state) {
  const ThreadLimit limit(static_cast<int>(state.range(3)));
  const ObservationSet set = even_cap(static_cast<std::size_t>(state.range(0)), static_cast<double>(state.range(1)));
  Thinner thinner(*find_thinning_method("analysis"));
  OptionTable table;
  thinner.declare_options(table);
  assign(table, "correlation_length_km", 150.0);
  assign(table, "retain_count", state.range(2));
  assign(table, "exchange", state.range(4) != 0);
  for (auto _ : state) {
    const PeakMemory memory;
    const Result<Choice> choice = thinner.thin(set);
    state.counters["retained"] = static_cast<double>(choice->retained.size());
    state.counters["MiB"] = static_cast<double>(memory.bytes_above_start().value_or(0)) / (1 << 20);
  }
}
BENCHMARK(analysis_on_a_cap)
    ->Args({10000, 40, 400, 1, 0})
    ->Args({10000, 40, 400, 1, 1})
    ->Args({10000, 20, 1100, 1, 0})
    ->Args({100000, 20, 11000, 1, 0})
    ->Args({100000, 20, 11000, 2, 0})
    ->Args({100000, 20, 11000, 1, 1})
    ->Args({10000, 20, 400, 1, 1})
    ->Args({100000, 20, 4000, 1, 1})
    ->Args({1000000, 20, 40000, 1, 1})
    ->Args({1000000, 20, 40000, 2, 1})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thin

BENCHMARK_MAIN();
