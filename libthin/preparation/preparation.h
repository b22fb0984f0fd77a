#pragma once

// From what the files hold to what is thinned: window, duplicates, screening, bias and first guess, in this order.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libthin/preparation/bias.h"
#include "libthin/preparation/companion.h"
#include "libthin/preparation/duplicates.h"
#include "libthin/preparation/first_guess.h"
#include "libthin/preparation/screening.h"
#include "libthin/preparation/surface.h"

namespace thin {

struct PreparationOptions {
  DuplicateOptions duplicates;
  ScreeningOptions screening;
  SurfaceOptions surface;
  BiasOptions bias;
  FirstGuessOptions first_guess;
  CompanionOptions companions;

  void declare(OptionTable& table);

  // What is wrong with the options taken together: the key and the problem.
  struct Conflict {
    std::string key;
    std::string problem;
  };
  std::optional<Conflict> conflict() const;
};

// What the files that the options name hold; whoever may read files reads them.
struct PreparationData {
  std::vector<std::string> file_names = {};  // [i] of source.file == i
  std::optional<Shoreline> shoreline = {};
  std::optional<BiasTable> bias_table = {};
  std::optional<BiasPredictors> bias_predictors = {};
  std::optional<ObservationSet> companions = {};
};

// Half open: begin_ms <= time < end_ms. Unset: no limit.
struct TimeWindow {
  std::optional<std::int64_t> begin_ms;
  std::optional<std::int64_t> end_ms;

  bool holds(std::int64_t time_ms) const {
    return (!begin_ms || time_ms >= *begin_ms) && (!end_ms || time_ms < *end_ms);
  }
};

// observations = near_duplicates + exact_duplicates + all screened + prepared
struct SounderTally {
  std::size_t observations = 0;  // in the window
  std::size_t near_duplicates = 0;
  std::size_t exact_duplicates = 0;
  std::map<ScreeningReason, std::size_t> screened;
  std::size_t prepared = 0;

  std::size_t duplicates() const { return near_duplicates + exact_duplicates; }
  std::size_t screened_count() const { return observations - duplicates() - prepared; }
};

struct Prepared {
  ObservationSet observations;        // canonical order, used channels alone, none missing that is measured
  std::vector<std::uint32_t> origin;  // index of each in the input
  std::map<Sounder, SounderTally> sounders;
  std::size_t outside_window = 0;
  std::size_t surfaces_filled = 0;  // by the land/sea mask
  std::vector<DeadChannel> dead_channels;
  BiasCounts bias;
  FirstGuessCounts first_guess;
  std::vector<std::string> notes;  // sentences for the log and the report
};

// Bias correction is for values as measured: an observation with the first guess of its file has that file's bias
// correction in it, and is left as it is. Errors: as screen().
Result<Prepared> prepare(const ObservationSet& observations, const TimeWindow& window,
                         const PreparationOptions& options, const PreparationData& data = {});

}  // namespace thin
