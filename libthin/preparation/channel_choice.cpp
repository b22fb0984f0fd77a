#include "libthin/preparation/channel_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace thin {
namespace {

using Places = std::vector<std::size_t>;

struct SounderCounts {
  std::size_t observations = 0;
  std::vector<std::size_t> missing;  // by channel place
};

std::map<Sounder, SounderCounts> count_missing(const ObservationSet& set, std::span<const std::uint32_t> fit,
                                               const ScreeningOptions& options) {
  std::map<Sounder, SounderCounts> counts;
  for (const std::uint32_t i : fit) {
    SounderCounts& sounder = counts[sounder_of(set, i)];
    sounder.missing.resize(set.channel_count());
    ++sounder.observations;
    const GrossLimits limits = options.limits_of(set.instrument[i]);
    const auto values = set.values_of(i);
    for (std::size_t place = 0; place < values.size(); ++place)
      sounder.missing[place] += value_state(values[place], set.value_kind, limits) != ValueState::good;
  }
  return counts;
}

// The channels of each instrument that has observations. A set without channel_instrument has one instrument, whatever
// it is.
std::map<Instrument, Places> places_by_instrument(const ObservationSet& set, std::span<const std::uint32_t> fit) {
  std::map<Instrument, Places> places;
  for (const std::uint32_t i : fit) places[set.instrument[i]];
  for (auto& [instrument, own] : places)
    for (std::size_t place = 0; place < set.channel_count(); ++place)
      if (set.channel_instrument.empty() || set.channel_instrument[place] == instrument) own.push_back(place);
  return places;
}

Result<Places> places_of(const std::vector<int>& wanted, const ObservationSet& set, Instrument instrument,
                         const Places& own) {
  Places places;
  for (const int channel : wanted) {
    const auto found = std::find_if(own.begin(), own.end(), [&](std::size_t p) { return set.channels[p] == channel; });
    if (found == own.end()) {
      std::vector<int> known;
      for (const std::size_t place : own) known.push_back(set.channels[place]);
      return Error{ErrorKind::configuration,
                   fmt::format("[preparation] channels names channel {}, but the instrument{} has {}", channel,
                               instrument == Instrument::unknown ? "" : fmt::format(" {}", instrument_name(instrument)),
                               fmt::join(known, ", "))};
    }
    places.push_back(*found);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

// The channels that the configuration names for an instrument; empty where it names none.
Result<std::vector<int>> named_channels(const ScreeningOptions& options, Instrument instrument, bool is_only) {
  if (const auto named = options.channels_of.find(instrument); named != options.channels_of.end()) return named->second;
  if (options.channels.empty() || is_only) return options.channels;
  return Error{ErrorKind::configuration,
               "[preparation] channels has numbers alone, but the window holds several instruments: say whose they are "
               "(\"amsua 5 6 7\", \"mhs 3 4 5\"), or choose one with [preparation] instruments"};
}

void add_dead(const std::map<Sounder, SounderCounts>& counts, const ObservationSet& set, Instrument instrument,
              const Places& places, double fraction, std::vector<DeadChannel>& dead) {
  for (const std::size_t place : places)
    for (const auto& [sounder, count] : counts) {
      if (sounder.second != instrument) continue;
      if (static_cast<double>(count.missing[place]) > fraction * static_cast<double>(count.observations))
        dead.push_back({set.channels[place], instrument, sounder.first, count.missing[place], count.observations});
    }
}

Places alive(const ObservationSet& set, Instrument instrument, const Places& own,
             const std::vector<DeadChannel>& dead) {
  Places places;
  std::copy_if(own.begin(), own.end(), std::back_inserter(places), [&](std::size_t place) {
    return std::none_of(dead.begin(), dead.end(), [&](const DeadChannel& one) {
      return one.channel == set.channels[place] && one.instrument == instrument;
    });
  });
  return places;
}

Error no_channel_left(const std::vector<DeadChannel>& dead) {
  std::vector<std::string> facts;
  facts.reserve(dead.size());
  for (const DeadChannel& channel : dead)
    facts.push_back(
        fmt::format("{} on {}", channel.channel, sounder_name(Sounder(channel.platform, channel.instrument))));
  return {ErrorKind::input,
          fmt::format("no channel is alive on every satellite of the window (dead: {}); name the channels to use in "
                      "[preparation] channels: satellites without them are then screened out",
                      fmt::join(facts, ", "))};
}

}  // namespace

ValueState value_state(double value_k, ValueKind kind, const GrossLimits& limits) {
  if (std::isnan(value_k)) return ValueState::missing;
  const bool inside = kind == ValueKind::innovation || (value_k >= limits.minimum_k && value_k <= limits.maximum_k);
  return inside ? ValueState::good : ValueState::outside;
}

Result<ChannelChoice> choose_channels(const ObservationSet& set, std::span<const std::uint32_t> fit,
                                      const ScreeningOptions& options) {
  ChannelChoice choice;
  const auto instruments = places_by_instrument(set, fit);
  if (instruments.empty()) {
    choice.places.resize(set.channel_count());
    std::iota(choice.places.begin(), choice.places.end(), std::size_t{0});
    return choice;
  }
  const auto counts = count_missing(set, fit, options);
  for (const auto& [instrument, own] : instruments) {
    const Result<std::vector<int>> named = named_channels(options, instrument, instruments.size() == 1);
    if (!named) return named.error();
    Result<Places> places = named->empty() ? Result<Places>(own) : places_of(*named, set, instrument, own);
    if (!places) return places.error();
    add_dead(counts, set, instrument, *places, options.dead_channel_fraction, choice.dead);
    const Places used = named->empty() ? alive(set, instrument, *places, choice.dead) : *places;
    choice.places.insert(choice.places.end(), used.begin(), used.end());
  }
  if (choice.places.empty()) return no_channel_left(choice.dead);
  std::sort(choice.places.begin(), choice.places.end());
  return choice;
}

}  // namespace thin
