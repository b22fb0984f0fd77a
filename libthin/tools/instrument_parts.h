#pragma once

// The instruments of one window one by one: each with its own observations and channels.

#include <cstdint>
#include <functional>
#include <span>

#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// Calls body(instrument, its observations with its channels alone, their indices in `observations`) for each
// instrument, in their order; ends at the first error. A set of one instrument is passed on as it is.
using InstrumentBody = std::function<Result<void>(Instrument, const ObservationSet&, std::span<const std::uint32_t>)>;
Result<void> each_instrument(const ObservationSet& observations, const InstrumentBody& body);

}  // namespace thin
