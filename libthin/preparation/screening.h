#pragma once

// Which observations and which channels are fit to be thinned.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

struct ScreeningOptions {
  std::vector<int> channels;           // empty: all that are alive on every satellite
  double dead_channel_fraction = 0.5;  // missing in more than this share of a satellite's observations: dead there
  double minimum_k = 50;
  double maximum_k = 400;

  void declare(OptionTable& table);
};

enum class ScreeningReason : std::uint8_t { none, missing_value, outside_limits };
const char* name_of(ScreeningReason reason);  // "missing value in a used channel"

struct DeadChannel {
  int channel;
  std::int32_t platform;
  std::size_t missing;       // there, of
  std::size_t observations;  // so many
};

struct Screening {
  std::vector<std::size_t> channel_places;  // the used channels, as places in ObservationSet::channels
  std::vector<ScreeningReason> reasons;     // n; none: fit
  std::vector<DeadChannel> dead;            // by channel, then platform; with options.channels: those among them
};

// A value outside the limits counts as missing when channels are judged; the limits hold for temperatures alone, not
// for innovations. Errors: configuration, where a channel asked for is not one of the instrument's; input, where no
// channel is alive on every satellite. An empty set screens to an empty set with all channels.
Result<Screening> screen(const ObservationSet& observations, const ScreeningOptions& options);

}  // namespace thin
