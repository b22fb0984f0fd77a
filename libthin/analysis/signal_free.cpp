#include "libthin/analysis/signal_free.h"

#include "libthin/estimation/neighbourhood_table.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

// est_P0 at each observation, n x channels.
std::vector<double> estimates(const NeighbourhoodTable& table, const ObservationSet& set) {
  const std::size_t channels = set.channel_count();
  std::vector<double> estimates(set.size() * channels, 0.0);
  parallel_ranges(set.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      double weights = 0;
      double* estimate = &estimates[q * channels];
      for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
        const auto values = set.values_of(table.observation[entry]);
        weights += table.weight[entry];
        for (std::size_t c = 0; c < channels; ++c)
          if (set.measures(q, c)) estimate[c] += table.weight[entry] * values[c];
      }
      for (std::size_t c = 0; c < channels; ++c) estimate[c] /= weights;
    }
  });
  return estimates;
}

// Of the numbers that it is given.
struct Variance {
  double count = 0, mean = 0, squares = 0;
  void add(double number) {
    ++count;
    const double step = number - mean;
    mean += step / count;
    squares += step * (number - mean);
  }
  double value() const { return count > 0 ? squares / count : 0; }
};

}  // namespace

Result<std::vector<std::uint8_t>> signal_free(const ObservationSet& set, const SignalFreeOptions& options) {
  const auto table = neighbourhood_table(places_of(set), {options.bandwidth_km});
  if (!table) return table.error();
  const std::size_t channels = set.channel_count();
  const std::vector<double> estimate = estimates(*table, set);
  std::vector<Variance> all(channels);
  for (std::size_t i = 0; i < set.size(); ++i)
    for (std::size_t c = 0; c < channels; ++c)
      if (set.measures(i, c)) all[c].add(estimate[i * channels + c]);

  std::vector<std::uint8_t> flags(set.size(), 0);
  parallel_ranges(set.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      double share = 0;
      std::size_t varying = 0;
      for (std::size_t c = 0; c < channels; ++c) {
        if (!set.measures(q, c) || !(all[c].value() > 0)) continue;
        Variance local;
        for (std::uint64_t entry = table->row_begin[q]; entry < table->row_begin[q + 1]; ++entry)
          local.add(estimate[table->observation[entry] * channels + c]);
        share += local.value() / all[c].value();
        ++varying;
      }
      flags[q] = share < options.largest_variance * static_cast<double>(varying) || varying == 0;
    }
  });
  return flags;
}

double share_of(const std::vector<std::uint8_t>& flags, const std::vector<std::uint32_t>& observations) {
  std::size_t count = 0;
  for (const std::uint32_t i : observations) count += flags[i] != 0;
  return observations.empty() ? 0 : static_cast<double>(count) / static_cast<double>(observations.size());
}

}  // namespace thin
