#include "libthin/preparation/screening.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "libthin/observations/platforms.h"

namespace thin {
namespace {

ScreeningReason judge(double value_k, ValueKind kind, const ScreeningOptions& options) {
  if (std::isnan(value_k)) return ScreeningReason::missing_value;
  const bool inside = kind == ValueKind::innovation || (value_k >= options.minimum_k && value_k <= options.maximum_k);
  return inside ? ScreeningReason::none : ScreeningReason::outside_limits;
}

struct PlatformCounts {
  std::size_t observations = 0;
  std::vector<std::size_t> missing;  // by channel place
};

std::map<std::int32_t, PlatformCounts> count_missing(const ObservationSet& set, const ScreeningOptions& options) {
  std::map<std::int32_t, PlatformCounts> counts;
  for (std::size_t i = 0; i < set.size(); ++i) {
    PlatformCounts& platform = counts[set.platform[i]];
    platform.missing.resize(set.channel_count());
    ++platform.observations;
    for (std::size_t place = 0; place < set.channel_count(); ++place)
      platform.missing[place] += judge(set.values_of(i)[place], set.value_kind, options) != ScreeningReason::none;
  }
  return counts;
}

std::vector<DeadChannel> dead_channels(const ObservationSet& set, const ScreeningOptions& options,
                                       const std::vector<std::size_t>& places) {
  const auto counts = count_missing(set, options);
  std::vector<DeadChannel> dead;
  for (const std::size_t place : places)
    for (const auto& [platform, count] : counts) {
      const double limit = options.dead_channel_fraction * static_cast<double>(count.observations);
      if (static_cast<double>(count.missing[place]) > limit)
        dead.push_back({set.channels[place], platform, count.missing[place], count.observations});
    }
  return dead;
}

Result<std::vector<std::size_t>> places_of(const std::vector<int>& wanted, const std::vector<int>& channels) {
  std::vector<std::size_t> places;
  for (const int channel : wanted) {
    const auto found = std::find(channels.begin(), channels.end(), channel);
    if (found == channels.end())
      return Error{ErrorKind::configuration,
                   fmt::format("[preparation] channels names channel {}, but the instrument has {}", channel,
                               fmt::join(channels, ", "))};
    places.push_back(static_cast<std::size_t>(found - channels.begin()));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

Error no_channel_left(const std::vector<DeadChannel>& dead) {
  std::vector<std::string> facts;
  facts.reserve(dead.size());
  for (const DeadChannel& channel : dead)
    facts.push_back(fmt::format("{} on {}", channel.channel, platform_name(channel.platform)));
  return {ErrorKind::input,
          fmt::format("no channel is alive on every satellite of the window (dead: {}); name the channels to use in "
                      "[preparation] channels: satellites without them are then screened out",
                      fmt::join(facts, ", "))};
}

}  // namespace

void ScreeningOptions::declare(OptionTable& table) {
  table.add("channels", channels,
            {.minimum = 1,
             .maximum = 10000,
             .explanation = "channels to thin by; empty: all that are alive on every satellite of the window"});
  table.add("dead_channel_fraction", dead_channel_fraction,
            {.minimum = 0,
             .maximum = 1,
             .explanation = "a channel missing in more than this share of a satellite's observations is dead there"});
  table.add("minimum_k", minimum_k, {.unit = "K", .explanation = "gross limit: a lower temperature is screened out"});
  table.add("maximum_k", maximum_k, {.unit = "K", .explanation = "gross limit: a higher temperature is screened out"});
}

const char* name_of(ScreeningReason reason) {
  switch (reason) {
    case ScreeningReason::none:
      return "none";
    case ScreeningReason::missing_value:
      return "missing value in a used channel";
    case ScreeningReason::outside_limits:
      return "temperature outside the gross limits";
  }
  return "";
}

Result<Screening> screen(const ObservationSet& set, const ScreeningOptions& options) {
  Screening screening;
  std::vector<std::size_t> all_places(set.channel_count());
  std::iota(all_places.begin(), all_places.end(), std::size_t{0});
  if (options.channels.empty()) {
    screening.dead = dead_channels(set, options, all_places);
    for (const std::size_t place : all_places) {
      const auto is_this = [&](const DeadChannel& dead) { return dead.channel == set.channels[place]; };
      if (std::none_of(screening.dead.begin(), screening.dead.end(), is_this))
        screening.channel_places.push_back(place);
    }
    if (screening.channel_places.empty()) return no_channel_left(screening.dead);
  } else {
    Result<std::vector<std::size_t>> places = places_of(options.channels, set.channels);
    if (!places) return places.error();
    screening.channel_places = std::move(*places);
    screening.dead = dead_channels(set, options, screening.channel_places);
  }

  screening.reasons.assign(set.size(), ScreeningReason::none);
  for (std::size_t i = 0; i < set.size(); ++i)
    for (const std::size_t place : screening.channel_places) {
      const ScreeningReason reason = judge(set.values_of(i)[place], set.value_kind, options);
      if (reason == ScreeningReason::none) continue;
      screening.reasons[i] = reason;
      break;
    }
  return screening;
}

}  // namespace thin
