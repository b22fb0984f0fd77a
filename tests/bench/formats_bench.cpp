// Reading observations beside a bare ecCodes loop over the same real files: open, unpack, nothing else. The counters
// tell the bare loop's time and how many times as long the reading takes; the same for extracting every third
// observation, whose bare counterpart is one more unpacking.

#include <benchmark/benchmark.h>
#include <eccodes.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"
#include "tests/support/shared_data.h"

namespace thin {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void unpack_file(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  int code = 0;
  while (codes_handle* handle = codes_bufr_handle_new_from_file(nullptr, file, &code)) {
    codes_set_long(handle, "unpack", 1);
    codes_handle_delete(handle);
  }
  std::fclose(file);
}

// Both in turn, so that whatever else the machine does falls on both alike.
template <class Work>
void beside_bare_loop(benchmark::State& state, const std::string& path, Work work) {
  unpack_file(path);  // the first use of ecCodes loads its tables
  double bare_s = 0;
  double ours_s = 0;
  for (auto _ : state) {
    const Clock::time_point bare_start = Clock::now();
    unpack_file(path);
    bare_s += seconds_since(bare_start);
    const Clock::time_point start = Clock::now();
    work();
    const double took_s = seconds_since(start);
    ours_s += took_s;
    state.SetIterationTime(took_s);
  }
  state.counters["bare_ms"] = 1000 * bare_s / static_cast<double>(state.iterations());
  state.counters["ratio"] = ours_s / bare_s;
}

void read_file(benchmark::State& state, const std::string& path) {
  beside_bare_loop(state, path, [&] { benchmark::DoNotOptimize(read_observations(path).ok()); });
}

void extract_file(benchmark::State& state, const std::string& path) {
  const auto contents = read_observations(path);
  std::vector<SourceReference> retained;
  for (std::size_t i = 0; i < contents->observations.size(); i += 3)
    retained.push_back(contents->observations.source[i]);
  const std::string output = (std::filesystem::temp_directory_path() / "thin_formats_bench.bufr").string();
  beside_bare_loop(state, path, [&] {
    std::filesystem::remove(output);  // outputs are new files; some file systems flush one that is replaced
    benchmark::DoNotOptimize(extract_observations(path, retained, output, {}).ok());
  });
  std::filesystem::remove(output);
}

void register_real_files() {
  for (const char* folder : {"amsua", "sounders"}) {
    const std::filesystem::path path = test::shared_data() / "observations" / folder;
    if (!std::filesystem::exists(path)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      const std::string file = entry.path().string();
      const std::string name = entry.path().filename().string();
      if (!read_observations(file).ok()) continue;
      benchmark::RegisterBenchmark(("read/" + name).c_str(), read_file, file)->UseManualTime();
      benchmark::RegisterBenchmark(("extract/" + name).c_str(), extract_file, file)->UseManualTime();
    }
  }
}

}  // namespace
}  // namespace thin

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  thin::register_real_files();
  if (benchmark::RunSpecifiedBenchmarks() == 0)
    std::fprintf(stderr, "no real files; set THIN_SHARED_DATA to their folder\n");
  return 0;
}
