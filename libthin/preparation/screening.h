#pragma once

// Which observations of a window are fit to be thinned, and why the others are not.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"
#include "libthin/preparation/channel_choice.h"
#include "libthin/preparation/screening_options.h"

namespace thin {

// Why an observation does not go on; of several reasons the first in this order, the rules on variables between the
// surface and the channels. The last three are given by the steps behind screening.
enum class ScreeningReason : std::uint16_t {
  none,
  platform,
  instrument,
  latitude,
  scan_position,
  surface,
  unknown_surface,
  no_live_channel,
  missing_value,
  outside_limits,
  no_bias_correction,
  no_first_guess,
  no_companion,
  first_rule,  // the rules on flags, then those on limits, in the order of the options
};

// "missing value in a used channel"; rules name their variable.
std::string name_of(ScreeningReason reason, const ScreeningOptions& options);

struct Screening {
  std::vector<std::size_t> channel_places;  // the used channels, as places in ObservationSet::channels
  std::vector<ScreeningReason> reasons;     // n; none: fit
  std::vector<DeadChannel> dead;            // as in ChannelChoice
  std::vector<std::string> absent;          // variables of rules that no observation has
};

// Selects by platform, instrument, latitude, scan position, surface and the rules on variables; then by the channels,
// which are chosen by what was selected (choose_channels, whose errors are passed on). An empty set screens to an empty
// set with all channels.
Result<Screening> screen(const ObservationSet& observations, const ScreeningOptions& options);

}  // namespace thin
