#pragma once

// Which channels of a window are used: those that the configuration names, or all that are alive on every satellite.
// Each instrument is judged by itself.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/instruments.h"
#include "libthin/preparation/screening_options.h"

namespace thin {

struct DeadChannel {
  int channel;
  Instrument instrument;
  std::int32_t platform;
  std::size_t missing;       // there, of
  std::size_t observations;  // so many
};

struct ChannelChoice {
  std::vector<std::size_t> places;  // the used channels, as places in ObservationSet::channels, ascending
  std::vector<DeadChannel> dead;    // by instrument, channel, platform; of named channels: those among them
};

// `fit`: the observations to judge by. A value outside the gross limits counts as missing. Instruments of which nothing
// is fit have no say, and no channel in `places`. Errors: configuration, where a channel asked for is not one of the
// instrument's, or is not said whose it is; input, where not one channel of the window is alive. Where nothing is fit
// all channels are used.
Result<ChannelChoice> choose_channels(const ObservationSet& observations, std::span<const std::uint32_t> fit,
                                      const ScreeningOptions& options);

// Missing, or a temperature outside the gross limits, which hold for temperatures alone, not for innovations.
enum class ValueState : std::uint8_t { good, missing, outside };
ValueState value_state(double value_k, ValueKind kind, const GrossLimits& limits);

}  // namespace thin
