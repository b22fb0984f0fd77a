#include "libthin/preparation/screening_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "libthin/observations/instruments.h"
#include "libthin/observations/platforms.h"

namespace thin {
namespace {

using Phrases = std::vector<std::string>;
using Problem = std::optional<std::string>;

constexpr Surface kSurfaces[] = {Surface::sea, Surface::land, Surface::coast, Surface::ice, Surface::unknown};
constexpr const char* kInstrumentsByName = "amsua, amsub, mhs, hirs, atms";

std::string unknown_instrument(const std::string& name) {
  return fmt::format("has the unknown instrument \"{}\"; known are {}", name, kInstrumentsByName);
}

Problem understand_platforms(const Phrases& phrases, std::set<std::int32_t>& platforms) {
  std::set<std::int32_t> numbers;
  for (const std::string& name : phrases) {
    const std::optional<int> number = whole_number(name);
    const std::optional<std::int32_t> known = number ? number : platform_number(name);
    if (!known)
      return fmt::format("has the unknown satellite \"{}\": write a name like \"Metop-B\" or its WMO number like \"3\"",
                         name);
    numbers.insert(*known);
  }
  platforms = std::move(numbers);
  return std::nullopt;
}

Problem understand_instruments(const Phrases& phrases, std::set<Instrument>& instruments) {
  std::set<Instrument> found;
  for (const std::string& name : phrases) {
    const std::optional<Instrument> instrument = find_instrument(name);
    if (!instrument) return unknown_instrument(name);
    found.insert(*instrument);
  }
  instruments = std::move(found);
  return std::nullopt;
}

// Adds "5" or "5-8".
Problem add_channels(const std::string& word, std::vector<int>& channels) {
  const std::size_t dash = word.find('-', 1);
  const std::optional<int> first = whole_number(word.substr(0, dash));
  const std::optional<int> last = dash == std::string::npos ? first : whole_number(word.substr(dash + 1));
  if (!first || !last || *first < 1 || *last < *first || *last > 10'000)
    return fmt::format("has \"{}\", which is no channel; write 5, or \"mhs 3 4 5\", or \"amsua 5-10\"", word);
  for (int channel = *first; channel <= *last; ++channel) channels.push_back(channel);
  return std::nullopt;
}

// Phrases are channels alone, or the channels of an instrument behind its name.
Problem understand_channels(const Phrases& phrases, std::vector<int>& channels,
                            std::map<Instrument, std::vector<int>>& channels_of) {
  std::vector<int> bare;
  std::map<Instrument, std::vector<int>> by_instrument;
  for (const std::string& phrase : phrases) {
    std::vector<std::string> words = words_of(phrase);
    if (words.empty()) return "has an empty text";
    std::vector<int>* into = &bare;
    if (!std::isdigit(static_cast<unsigned char>(words.front().front())) && words.front().front() != '-') {
      const std::optional<Instrument> instrument = find_instrument(words.front());
      if (!instrument) return unknown_instrument(words.front());
      if (words.size() == 1) return fmt::format("names no channel behind \"{}\"", words.front());
      into = &by_instrument[*instrument];
      words.erase(words.begin());
    }
    for (const std::string& word : words)
      if (Problem problem = add_channels(word, *into)) return problem;
  }
  channels = std::move(bare);
  channels_of = std::move(by_instrument);
  return std::nullopt;
}

Problem understand_surfaces(const Phrases& phrases, std::set<Surface>& surfaces) {
  std::set<Surface> found;
  for (const std::string& name : phrases) {
    const auto* surface =
        std::find_if(std::begin(kSurfaces), std::end(kSurfaces), [&](Surface s) { return surface_name(s) == name; });
    if (surface == std::end(kSurfaces))
      return fmt::format("has the unknown surface \"{}\"; known are sea, land, coast, ice, unknown", name);
    found.insert(*surface);
  }
  surfaces = std::move(found);
  return std::nullopt;
}

// "3" for all instruments, "mhs 9" for one.
Problem understand_edges(const Phrases& phrases, int& skip_edge, std::map<Instrument, int>& skip_edge_of) {
  int for_all = 0;
  std::map<Instrument, int> by_instrument;
  for (const std::string& phrase : phrases) {
    const std::vector<std::string> words = words_of(phrase);
    const std::optional<int> count = words.empty() ? std::nullopt : whole_number(words.back());
    if (!count || *count < 0 || words.size() > 2)
      return fmt::format("has \"{}\"; write a number of scan positions like 3, or \"mhs 9\"", phrase);
    const std::optional<Instrument> instrument = words.size() == 2 ? find_instrument(words.front()) : std::nullopt;
    if (words.size() == 2 && !instrument) return unknown_instrument(words.front());
    const int most = instrument ? (fields_of_view_per_line(*instrument) - 1) / 2 : 47;
    if (*count > most) return fmt::format("has \"{}\": at most {} can be left out at each end", phrase, most);
    (instrument ? by_instrument[*instrument] : for_all) = *count;
  }
  skip_edge = for_all;
  skip_edge_of = std::move(by_instrument);
  return std::nullopt;
}

// The last two of three words as an interval.
std::optional<std::pair<double, double>> interval_of(const std::vector<std::string>& words) {
  if (words.size() != 3) return std::nullopt;
  const std::optional<double> low = finite_number(words[1]), high = finite_number(words[2]);
  if (!low || !high || *low > *high) return std::nullopt;
  return std::pair(*low, *high);
}

Problem understand_gross_limits(const Phrases& phrases, std::map<Instrument, GrossLimits>& limits) {
  std::map<Instrument, GrossLimits> found;
  for (const std::string& phrase : phrases) {
    const std::vector<std::string> words = words_of(phrase);
    const auto interval = interval_of(words);
    if (!interval) return fmt::format("has \"{}\"; write instrument, lower and upper limit: \"mhs 100 340\"", phrase);
    const std::optional<Instrument> instrument = find_instrument(words.front());
    if (!instrument) return unknown_instrument(words.front());
    found[*instrument] = {interval->first, interval->second};
  }
  limits = std::move(found);
  return std::nullopt;
}

std::optional<std::uint64_t> mask_of(const std::string& text) {
  const bool hexadecimal = text.starts_with("0x");
  const char* begin = text.data() + (hexadecimal ? 2 : 0);
  const char* end = text.data() + text.size();
  std::uint64_t mask = 0;
  const auto [last, error] = std::from_chars(begin, end, mask, hexadecimal ? 16 : 10);
  if (error != std::errc() || last != end || begin == end || mask == 0) return std::nullopt;
  return mask;
}

Problem understand_flags(const Phrases& phrases, std::vector<FlagRule>& rules) {
  std::vector<FlagRule> found;
  for (const std::string& phrase : phrases) {
    const std::vector<std::string> words = words_of(phrase);
    const std::optional<std::uint64_t> mask = words.size() == 2 ? mask_of(words[1]) : std::nullopt;
    if (words.empty() || words.size() > 2 || (words.size() == 2 && !mask))
      return fmt::format(
          "has \"{}\"; write the name of a variable that must be 0, or with a mask of the bits that "
          "must be 0: \"scan_line_quality_flags 0x3\"",
          phrase);
    found.push_back({words.front(), mask});
  }
  rules = std::move(found);
  return std::nullopt;
}

Problem understand_variables(const Phrases& phrases, std::vector<VariableRule>& rules) {
  std::vector<VariableRule> found;
  for (const std::string& phrase : phrases) {
    const std::vector<std::string> words = words_of(phrase);
    const auto interval = interval_of(words);
    if (!interval)
      return fmt::format("has \"{}\"; write the name of a variable and its limits: \"satellite_zenith_angle_deg 0 55\"",
                         phrase);
    found.push_back({words.front(), interval->first, interval->second});
  }
  rules = std::move(found);
  return std::nullopt;
}

}  // namespace

const char* surface_name(Surface surface) {
  switch (surface) {
    case Surface::sea:
      return "sea";
    case Surface::land:
      return "land";
    case Surface::coast:
      return "coast";
    case Surface::ice:
      return "ice";
    case Surface::unknown:
      break;
  }
  return "unknown";
}

GrossLimits default_gross_limits(Instrument instrument) {
  switch (instrument) {
    case Instrument::amsua:
    case Instrument::amsub:
    case Instrument::mhs:
    case Instrument::atms:
      return {70, 340};
    case Instrument::hirs:
      return {150, 380};
    case Instrument::unknown:
      break;
  }
  return {50, 400};
}

GrossLimits ScreeningOptions::limits_of(Instrument instrument) const {
  if (const auto named = gross_limits.find(instrument); named != gross_limits.end()) return named->second;
  const GrossLimits usual = default_gross_limits(instrument);
  return {minimum_k.value_or(usual.minimum_k), maximum_k.value_or(usual.maximum_k)};
}

int ScreeningOptions::skipped_edge_of(Instrument instrument) const {
  const auto named = skip_edge_of.find(instrument);
  return named == skip_edge_of.end() ? skip_edge : named->second;
}

void ScreeningOptions::declare(OptionTable& table) {
  table.add_phrases("platforms", written_.platforms,
                    {.explanation = "satellites to use, by name or WMO number; empty: all"},
                    [this](const Phrases& phrases) { return understand_platforms(phrases, platforms); });
  table.add_phrases("instruments", written_.instruments,
                    {.explanation = "instruments to use: amsua, amsub, mhs, hirs, atms; empty: all"},
                    [this](const Phrases& phrases) { return understand_instruments(phrases, instruments); });
  table.add_phrases("channels", written_.channels,
                    {.explanation = "channels to thin by: [5, 6] of the only instrument, [\"amsua 5-10\", \"mhs 3 4 "
                                    "5\"] of several; empty, and for instruments not named: all that are alive on "
                                    "every satellite of the window"},
                    [this](const Phrases& phrases) { return understand_channels(phrases, channels, channels_of); });
  table.add("dead_channel_fraction", dead_channel_fraction,
            {.minimum = 0,
             .maximum = 1,
             .explanation = "a channel missing in more than this share of a satellite's observations is dead there"});
  table.add_phrases("surface", written_.surfaces,
                    {.explanation = "surfaces to use: sea, land, coast, ice, unknown; empty: all"},
                    [this](const Phrases& phrases) { return understand_surfaces(phrases, surfaces); });
  table.add_phrases(
      "skip_edge_positions", written_.skip_edge,
      {.explanation = "scan positions to leave out at each end of the line: 3, or [\"amsua 3\", \"mhs 9\"]"},
      [this](const Phrases& phrases) { return understand_edges(phrases, skip_edge, skip_edge_of); });
  table.add("minimum_latitude_deg", minimum_latitude_deg,
            {.unit = "degrees north", .minimum = -90, .maximum = 90, .explanation = "latitude band to use: from ..."});
  table.add("maximum_latitude_deg", maximum_latitude_deg,
            {.unit = "degrees north", .minimum = -90, .maximum = 90, .explanation = "... to"});
  table.add("minimum_k", minimum_k,
            {.unit = "K",
             .explanation = "gross limit: a lower temperature is screened out; unset: 70 for microwave, 150 for HIRS"});
  table.add("maximum_k", maximum_k,
            {.unit = "K",
             .explanation = "gross limit: a higher temperature is screened out; unset: 340 for microwave, 380 for "
                            "HIRS"});
  table.add_phrases("gross_limits", written_.gross_limits,
                    {.unit = "K", .explanation = "of an instrument, before minimum_k and maximum_k: [\"mhs 100 340\"]"},
                    [this](const Phrases& phrases) { return understand_gross_limits(phrases, gross_limits); });
  table.add_phrases("reject_flagged", written_.flags,
                    {.explanation = "variables that must be 0, or of which the bits of a mask must be 0: "
                                    "[\"field_of_view_quality_flags\", \"scan_line_quality_flags 0x3\"]"},
                    [this](const Phrases& phrases) { return understand_flags(phrases, flags); });
  table.add_phrases("variable_limits", written_.variables,
                    {.explanation = "variables with the limits that they must keep: [\"satellite_zenith_angle_deg 0 "
                                    "55\"]; where one is missing the observation goes"},
                    [this](const Phrases& phrases) { return understand_variables(phrases, variables); });
}

}  // namespace thin
