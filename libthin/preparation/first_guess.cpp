#include "libthin/preparation/first_guess.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "libthin/observations/platforms.h"

namespace thin {
namespace {

// Sums over a group of observations, per channel.
struct Mean {
  std::size_t count = 0;
  std::vector<double> sum;

  void add(std::span<const double> values) {
    sum.resize(values.size());
    ++count;
    for (std::size_t c = 0; c < values.size(); ++c) sum[c] += values[c];
  }
  double of(std::size_t channel) const { return sum[channel] / static_cast<double>(count); }
};

using Platform = std::int32_t;
using ScanPosition = std::pair<Platform, std::int32_t>;

// Satellites with too few lines for means of their scan positions: all positions alike, so that no step arises between
// neighbours of which one has a mean of its own. By platform, the observations per known scan position.
std::map<Platform, double> satellites_with_few_lines(const std::map<ScanPosition, Mean>& positions, int minimum_lines) {
  std::map<Platform, std::pair<std::size_t, std::size_t>> counts;  // observations, positions
  for (const auto& [position, mean] : positions) {
    counts[position.first].first += mean.count;
    counts[position.first].second += position.second != kUnknownNumber;
  }
  std::map<Platform, double> few;
  for (const auto& [platform, count] : counts) {
    const double lines = count.second ? static_cast<double>(count.first) / static_cast<double>(count.second) : 0;
    if (lines < minimum_lines) few[platform] = lines;
  }
  return few;
}

void subtract_scan_position_means(ObservationSet& set, int minimum_lines, std::vector<std::string>& notes) {
  std::map<Platform, Mean> platforms;
  std::map<ScanPosition, Mean> positions;
  for (std::size_t i = 0; i < set.size(); ++i) {
    platforms[set.platform[i]].add(set.values_of(i));
    positions[{set.platform[i], set.field_of_view[i]}].add(set.values_of(i));
  }
  const auto few_lines = satellites_with_few_lines(positions, minimum_lines);

  const std::size_t channels = set.channel_count();
  for (std::size_t i = 0; i < set.size(); ++i) {
    const bool of_satellite = few_lines.contains(set.platform[i]) || set.field_of_view[i] == kUnknownNumber;
    const Mean& mean = of_satellite ? platforms[set.platform[i]] : positions[{set.platform[i], set.field_of_view[i]}];
    for (std::size_t c = 0; c < channels; ++c) set.values[i * channels + c] -= mean.of(c);
  }
  for (const auto& [platform, lines] : few_lines)
    notes.push_back(fmt::format(
        "{}: {:.1f} observations of each scan position are fewer than {}: the first guess is the mean of the "
        "satellite, "
        "and the limb effect stays in; thin longer windows, or lower [preparation] first_guess_minimum_lines",
        platform_name(platform), lines, minimum_lines));
}

void subtract_large_means(ObservationSet& set, std::vector<std::string>& notes) {
  const std::size_t n = set.size(), channels = set.channel_count();
  for (std::size_t c = 0; c < channels; ++c) {
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) sum += set.values[i * channels + c];
    const double mean = n ? sum / static_cast<double>(n) : 0;
    for (std::size_t i = 0; i < n; ++i) squares += std::pow(set.values[i * channels + c] - mean, 2);
    const double deviation = n ? std::sqrt(squares / static_cast<double>(n)) : 0;
    if (std::abs(mean) <= 0.5 * deviation) continue;
    // The scan-position means leave nothing but rounding behind; that is no bias.
    if (std::abs(mean) < 1e-9) continue;
    for (std::size_t i = 0; i < n; ++i) set.values[i * channels + c] -= mean;
    notes.push_back(
        fmt::format("channel {}: the mean {:.3f} K is more than half the standard deviation {:.3f} K and was taken off "
                    "before thinning",
                    set.channels[c], mean, deviation));
  }
}

}  // namespace

void FirstGuessOptions::declare(OptionTable& table) {
  table.add_choice("first_guess", first_guess,
                   std::vector<std::pair<std::string, FirstGuess>>{
                       {"scan_position_mean", FirstGuess::scan_position_mean}, {"none", FirstGuess::none}},
                   {.explanation = "what is subtracted from temperatures before thinning: the window's mean per "
                                   "satellite, channel and field of view, or nothing"});
  table.add(
      "first_guess_minimum_lines", minimum_lines,
      {.unit = "scan lines",
       .minimum = 1,
       .explanation = "a satellite with fewer lines in the window takes its mean over all scan positions instead"});
}

void subtract_first_guess(ObservationSet& set, const FirstGuessOptions& options, std::vector<std::string>& notes) {
  if (set.value_kind == ValueKind::brightness_temperature) {
    if (!set.first_guess_k.empty() && options.first_guess != FirstGuess::none) {
      for (std::size_t i = 0; i < set.values.size(); ++i) set.values[i] -= set.first_guess_k[i];
      set.value_kind = ValueKind::innovation;
      notes.emplace_back("the first guess is the files' own");
    } else if (options.first_guess == FirstGuess::scan_position_mean) {
      subtract_scan_position_means(set, options.minimum_lines, notes);
      set.value_kind = ValueKind::innovation;
    } else {
      notes.emplace_back("the values are not innovations: brightness temperatures are thinned without a first guess");
    }
  }
  subtract_large_means(set, notes);
}

}  // namespace thin
