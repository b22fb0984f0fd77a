#include "libthin/analysis/signal_free.h"

#include <algorithm>

#include "libthin/estimation/neighbourhood_table.h"
#include "libthin/foundation/parallel.h"

namespace thin {
namespace {

constexpr double kChiSquaredMedian = 0.45493642311957283;  // of one degree of freedom
// Of the whole variance: what rounding leaves where nothing varies.
constexpr double kRounding = 1e-12;

// The full set's filter at its own observations.
struct Filtered {
  std::vector<double> estimates;        // n x channels
  std::vector<double> weight_sums;      // n: sum w
  std::vector<double> remaining_noise;  // n: sum w² / (sum w)², the share of white noise's variance that is left
};

Filtered filtered(const NeighbourhoodTable& table, const ObservationSet& set) {
  const std::size_t channels = set.channel_count();
  Filtered result{std::vector<double>(set.size() * channels, 0.0), std::vector<double>(set.size(), 0.0),
                  std::vector<double>(set.size(), 0.0)};
  parallel_ranges(set.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      double weights = 0, squares = 0;
      double* estimate = &result.estimates[q * channels];
      for (std::uint64_t entry = table.row_begin[q]; entry < table.row_begin[q + 1]; ++entry) {
        const double weight = table.weight[entry];
        const auto values = set.values_of(table.observation[entry]);
        weights += weight;
        squares += weight * weight;
        for (std::size_t c = 0; c < channels; ++c)
          if (set.measures(q, c)) estimate[c] += weight * values[c];
      }
      for (std::size_t c = 0; c < channels; ++c) estimate[c] /= weights;
      result.weight_sums[q] = weights;
      result.remaining_noise[q] = squares / (weights * weights);
    }
  });
  return result;
}

// sigma² of a channel.
double noise_variance(const Filtered& filter, const ObservationSet& set, std::size_t channel) {
  std::vector<double> squares;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double kept = 1 - 2 / filter.weight_sums[i] + filter.remaining_noise[i];
    if (!set.measures(i, channel) || !(kept > kRounding)) continue;  // alone: the estimate is the observation
    const double departure = set.values_of(i)[channel] - filter.estimates[i * set.channel_count() + channel];
    squares.push_back(departure * departure / kept);
  }
  if (squares.empty()) return 0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / kChiSquaredMedian;
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

struct Channel {
  double variance = 0;  // of the estimate over all observations
  double noise = 0;     // sigma² in units of it
};

std::vector<Channel> channels_of(const Filtered& filter, const ObservationSet& set) {
  std::vector<Channel> channels(set.channel_count());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    Variance all;
    for (std::size_t i = 0; i < set.size(); ++i)
      if (set.measures(i, c)) all.add(filter.estimates[i * channels.size() + c]);
    channels[c].variance = all.value();
    if (all.value() > 0) channels[c].noise = noise_variance(filter, set, c) / all.value();
  }
  return channels;
}

}  // namespace

Result<std::vector<std::uint8_t>> signal_free(const ObservationSet& set, const SignalFreeOptions& options) {
  const auto table = neighbourhood_table(places_of(set), {options.bandwidth_km});
  if (!table) return table.error();
  const Filtered filter = filtered(*table, set);
  const std::vector<Channel> channels = channels_of(filter, set);

  std::vector<std::uint8_t> flags(set.size(), 0);
  parallel_ranges(set.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      double varies = 0, by_noise = 0;  // sums over the channels
      for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!set.measures(q, c) || !(channels[c].variance > 0)) continue;
        Variance near;
        for (std::uint64_t entry = table->row_begin[q]; entry < table->row_begin[q + 1]; ++entry)
          near.add(filter.estimates[table->observation[entry] * channels.size() + c]);
        varies += near.value() / channels[c].variance;
        by_noise += channels[c].noise * filter.remaining_noise[q] + kRounding;
      }
      flags[q] = varies <= options.noise_factor * by_noise;
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
