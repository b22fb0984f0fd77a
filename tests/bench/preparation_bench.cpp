// The preparation's steps alone, on 100,000 observations of AMSU-A of four satellites.

#include <benchmark/benchmark.h>

#include "libthin/formats/shoreline_file.h"
#include "libthin/observations/orbit.h"
#include "libthin/observations/scan_geometry.h"
#include "libthin/preparation/preparation.h"

namespace thin {
namespace {

const ObservationSet& soundings() {
  static const ObservationSet set = [] {
    ObservationSet made;
    for (int channel = 1; channel <= 15; ++channel) made.channels.push_back(channel);
    const std::vector<double> values(15, 230.0);
    for (std::int64_t line = 0; made.size() < 100'000; ++line)
      for (const char* name : {"NOAA-15", "NOAA-16", "NOAA-18", "Metop-A"}) {
        const Orbit orbit(*find_orbit(name));
        int field_of_view = 0;
        for (const FieldOfView& view : amsua_scan_line(orbit, 1'164'148'200'000 + line * kAmsuaLineMs))
          made.push_back({.latitude_deg = view.latitude_deg,
                          .longitude_deg = view.longitude_deg,
                          .time_ms = view.time_ms,
                          .platform = orbit.platform(),
                          .instrument = Instrument::amsua,
                          .scan_line = static_cast<std::int32_t>(line),
                          .field_of_view = ++field_of_view,
                          .source = {}},
                         values);
      }
    return made.select(canonical_order(made));
  }();
  return set;
}

void duplicates(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(find_duplicates(soundings(), {}, {}));
}
BENCHMARK(duplicates)->Unit(benchmark::kMillisecond);

void screening(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(screen(soundings(), {}));
}
BENCHMARK(screening)->Unit(benchmark::kMillisecond);

void whole_preparation(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(prepare(soundings(), {}, {}));
}
BENCHMARK(whole_preparation)->Unit(benchmark::kMillisecond);

void shoreline_built(benchmark::State& state) {
  const auto edges = read_shoreline(SurfaceOptions().land_sea_mask);
  if (!edges) return state.SkipWithError(edges.error().message.c_str());
  for (auto _ : state) benchmark::DoNotOptimize(Shoreline(*edges));
}
BENCHMARK(shoreline_built)->Unit(benchmark::kMillisecond);

void surfaces(benchmark::State& state) {
  const auto edges = read_shoreline(SurfaceOptions().land_sea_mask);
  if (!edges) return state.SkipWithError(edges.error().message.c_str());
  const Shoreline shoreline(*edges);
  for (auto _ : state) {
    state.PauseTiming();
    ObservationSet set = soundings();
    state.ResumeTiming();
    benchmark::DoNotOptimize(fill_surfaces(set, shoreline, 50));
  }
}
BENCHMARK(surfaces)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace thin

BENCHMARK_MAIN();
