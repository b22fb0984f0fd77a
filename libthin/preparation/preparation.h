#pragma once

// From what the files hold to what is thinned: window, screening, first guess, in this order.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libthin/preparation/first_guess.h"
#include "libthin/preparation/screening.h"

namespace thin {

struct PreparationOptions {
  ScreeningOptions screening;
  FirstGuessOptions first_guess;

  void declare(OptionTable& table);
};

// Half open: begin_ms <= time < end_ms. Unset: no limit.
struct TimeWindow {
  std::optional<std::int64_t> begin_ms;
  std::optional<std::int64_t> end_ms;

  bool holds(std::int64_t time_ms) const {
    return (!begin_ms || time_ms >= *begin_ms) && (!end_ms || time_ms < *end_ms);
  }
};

struct PlatformTally {
  std::size_t observations = 0;  // in the window
  std::map<ScreeningReason, std::size_t> screened;
  std::size_t prepared = 0;
};

struct Prepared {
  ObservationSet observations;        // canonical order, used channels alone, nothing missing
  std::vector<std::uint32_t> origin;  // index of each in the input
  std::map<std::int32_t, PlatformTally> platforms;
  std::size_t outside_window = 0;
  std::vector<DeadChannel> dead_channels;
  std::vector<std::string> notes;  // sentences for the log and the report
};

// Errors: as screen().
Result<Prepared> prepare(const ObservationSet& observations, const TimeWindow& window,
                         const PreparationOptions& options);

}  // namespace thin
