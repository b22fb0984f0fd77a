#include "libthin/preparation/first_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "libthin/observations/instruments.h"

namespace thin {
namespace {

// Sums over a group of observations, per channel. Channels that the group does not measure stay NaN.
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

using ScanPosition = std::pair<Sounder, std::int32_t>;

// Satellites with too few lines for means of their scan positions: all positions alike, so that no step arises between
// neighbours of which one has a mean of its own. By sounder, the observations per known scan position.
std::map<Sounder, double> sounders_with_few_lines(const std::map<ScanPosition, Mean>& positions, int minimum_lines) {
  std::map<Sounder, std::pair<std::size_t, std::size_t>> counts;  // observations, positions
  for (const auto& [position, mean] : positions) {
    counts[position.first].first += mean.count;
    counts[position.first].second += position.second != kUnknownNumber;
  }
  std::map<Sounder, double> few;
  for (const auto& [sounder, count] : counts) {
    const double lines = count.second ? static_cast<double>(count.first) / static_cast<double>(count.second) : 0;
    if (lines < minimum_lines) few[sounder] = lines;
  }
  return few;
}

void subtract_scan_position_means(ObservationSet& set, const std::vector<GuessSource>& sources, int minimum_lines,
                                  std::vector<std::string>& notes) {
  std::map<Sounder, Mean> sounders;
  std::map<ScanPosition, Mean> positions;
  const auto takes_mean = [&](std::size_t i) { return sources[i] == GuessSource::scan_position_mean; };
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!takes_mean(i)) continue;
    sounders[sounder_of(set, i)].add(set.values_of(i));
    positions[{sounder_of(set, i), set.field_of_view[i]}].add(set.values_of(i));
  }
  const auto few_lines = sounders_with_few_lines(positions, minimum_lines);

  const std::size_t channels = set.channel_count();
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!takes_mean(i)) continue;
    const Sounder sounder = sounder_of(set, i);
    const bool of_satellite = few_lines.contains(sounder) || set.field_of_view[i] == kUnknownNumber;
    const Mean& mean = of_satellite ? sounders[sounder] : positions[{sounder, set.field_of_view[i]}];
    for (std::size_t c = 0; c < channels; ++c) set.values[i * channels + c] -= mean.of(c);
  }
  for (const auto& [sounder, lines] : few_lines)
    notes.push_back(fmt::format(
        "{}: {:.1f} observations of each scan position are fewer than {}: the first guess is the mean of the "
        "satellite, and the limb effect stays in; thin longer windows, or lower [preparation] "
        "first_guess_minimum_lines",
        sounder_name(sounder), lines, minimum_lines));
}

// Of the values of one channel that are there.
struct Moments {
  double mean = 0, deviation = 0;
};

Moments moments_of(const ObservationSet& set, std::size_t c) {
  const std::size_t channels = set.channel_count();
  std::size_t count = 0;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < set.size(); ++i)
    if (set.measures(i, c)) sum += set.values[i * channels + c], ++count;
  if (count == 0) return {};
  const double mean = sum / static_cast<double>(count);
  for (std::size_t i = 0; i < set.size(); ++i)
    if (set.measures(i, c)) squares += std::pow(set.values[i * channels + c] - mean, 2);
  return {mean, std::sqrt(squares / static_cast<double>(count))};
}

void subtract_large_means(ObservationSet& set, std::vector<std::string>& notes) {
  const std::size_t channels = set.channel_count();
  for (std::size_t c = 0; c < channels; ++c) {
    const auto [mean, deviation] = moments_of(set, c);
    if (std::abs(mean) <= 0.5 * deviation) continue;
    // The scan-position means leave nothing but rounding behind; that is no bias.
    if (std::abs(mean) < 1e-9) continue;
    for (std::size_t i = 0; i < set.size(); ++i) set.values[i * channels + c] -= mean;
    notes.push_back(fmt::format(
        "{}channel {}: the mean {:.3f} K is more than half the standard deviation {:.3f} K and was taken "
        "off before thinning",
        set.channel_instrument.empty() ? "" : fmt::format("{} ", instrument_name(set.channel_instrument[c])),
        set.channels[c], mean, deviation));
  }
}

void subtract_given(ObservationSet& set, const std::vector<GuessSource>& sources) {
  const std::size_t channels = set.channel_count();
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (sources[i] != GuessSource::given) continue;
    for (std::size_t c = 0; c < channels; ++c) set.values[i * channels + c] -= set.first_guess_k[i * channels + c];
  }
}

bool is_whole(const ObservationSet& set, std::size_t i) {
  if (set.first_guess_k.empty()) return false;
  for (std::size_t c = 0; c < set.channel_count(); ++c)
    if (set.measures(i, c) && std::isnan(set.first_guess_k[i * set.channel_count() + c])) return false;
  return true;
}

using FileInstrument = std::pair<std::uint32_t, Instrument>;

std::set<FileInstrument> files_with_first_guess(const ObservationSet& set) {
  std::set<FileInstrument> files;
  const auto channels = static_cast<std::ptrdiff_t>(set.channel_count());
  for (std::size_t i = 0; i < set.size() && !set.first_guess_k.empty(); ++i) {
    const auto first = set.first_guess_k.begin() + static_cast<std::ptrdiff_t>(i) * channels;
    if (std::any_of(first, first + channels, [](double value) { return !std::isnan(value); }))
      files.emplace(set.source[i].file, set.instrument[i]);
  }
  return files;
}

FirstGuessCounts count(const std::vector<GuessSource>& sources) {
  const auto of = [&](GuessSource source) {
    return static_cast<std::size_t>(std::count(sources.begin(), sources.end(), source));
  };
  return {of(GuessSource::innovation), of(GuessSource::given), of(GuessSource::scan_position_mean),
          of(GuessSource::none)};
}

}  // namespace

void FirstGuessOptions::declare(OptionTable& table) {
  table.add_choice(
      "first_guess", first_guess,
      std::vector<std::pair<std::string, FirstGuess>>{{"auto", FirstGuess::automatic},
                                                      {"file", FirstGuess::file},
                                                      {"companion", FirstGuess::companion},
                                                      {"scan_position_mean", FirstGuess::scan_position_mean},
                                                      {"none", FirstGuess::none}},
      {.explanation = "what is subtracted from temperatures before thinning: the file's own first guess, that of "
                      "companion_files, the window's mean per satellite, channel and field of view, or nothing; auto: "
                      "the file's where it has one, else the mean"});
  table.add(
      "first_guess_minimum_lines", minimum_lines,
      {.unit = "scan lines",
       .minimum = 1,
       .explanation = "a satellite with fewer lines in the window takes its mean over all scan positions instead"});
}

std::vector<GuessSource> first_guess_sources(const ObservationSet& set, FirstGuess first_guess) {
  if (set.value_kind == ValueKind::innovation) return std::vector(set.size(), GuessSource::innovation);
  if (first_guess == FirstGuess::scan_position_mean) return std::vector(set.size(), GuessSource::scan_position_mean);
  if (first_guess == FirstGuess::none) return std::vector(set.size(), GuessSource::none);
  const bool automatic = first_guess == FirstGuess::automatic;
  const std::set<FileInstrument> files = automatic ? files_with_first_guess(set) : std::set<FileInstrument>();
  std::vector<GuessSource> sources(set.size(), GuessSource::scan_position_mean);
  for (std::size_t i = 0; i < set.size(); ++i)
    if (!automatic || files.contains({set.source[i].file, set.instrument[i]}))
      sources[i] = is_whole(set, i) ? GuessSource::given : GuessSource::missing;
  return sources;
}

FirstGuessCounts subtract_first_guess(ObservationSet& set, const std::vector<GuessSource>& sources,
                                      const FirstGuessOptions& options, std::vector<std::string>& notes) {
  const FirstGuessCounts counts = count(sources);
  subtract_given(set, sources);
  if (counts.scan_position_mean > 0) subtract_scan_position_means(set, sources, options.minimum_lines, notes);
  if (counts.given > 0 && counts.scan_position_mean > 0)
    notes.push_back(
        fmt::format("{} observations have the first guess of their file, {} the mean of their scan position: their "
                    "innovations are not alike; see [preparation] first_guess",
                    counts.given, counts.scan_position_mean));
  if (counts.none > 0)
    notes.emplace_back("the values are not innovations: brightness temperatures are thinned without a first guess");
  else
    set.value_kind = ValueKind::innovation;
  set.first_guess_k.clear();
  subtract_large_means(set, notes);
  return counts;
}

}  // namespace thin
