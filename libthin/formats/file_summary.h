#pragma once

// What is in a file of soundings, at a glance.

#include <cstdint>
#include <string>
#include <vector>

#include "libthin/formats/observation_file.h"

namespace thin {

// Statistics of one channel over all observations that have it; the temperatures are NaN where none is present.
struct ChannelSummary {
  Instrument instrument = Instrument::unknown;  // unknown: of all observations
  int channel = 0;
  std::uint64_t present = 0;
  std::uint64_t missing = 0;
  double minimum_k = 0, mean_k = 0, maximum_k = 0;
  double innovation_mean_k = 0, innovation_deviation_k = 0;  // of those with a first guess; NaN where none has one
};

struct PlatformSummary {
  std::int32_t platform = 0;
  std::uint64_t observations = 0;
};

struct InstrumentSummary {
  Instrument instrument = Instrument::unknown;
  std::uint64_t observations = 0;
};

// The smallest box that holds all positions. It may cross the date line: then west_deg > east_deg.
struct Area {
  double south_deg = 0, north_deg = 0, west_deg = 0, east_deg = 0;
};

struct FileSummary {
  std::string layout;
  std::string instrument;
  // Of BUFR alone.
  std::vector<int> editions;     // of its messages, ascending, each once
  std::vector<int> descriptors;  // unexpanded (310009), of the messages in use, in order of appearance, each once
  std::uint32_t messages = 0;
  std::uint32_t messages_in_use = 0;
  std::uint64_t subsets_in_use = 0;  // of these messages; more than observations where some lack a position or time
  std::uint64_t observations = 0;
  std::vector<SkippedPart> skipped;
  std::vector<std::string> notes;  // on how it was read
  bool has_first_guess = false;
  std::vector<PlatformSummary> platforms;  // by number
  std::vector<InstrumentSummary> instruments;
  std::int64_t first_time_ms = 0, last_time_ms = 0;
  std::uint64_t scan_lines = 0;  // different known ones; the same number of two satellites is two
  Area area;
  std::vector<ChannelSummary> channels;
};

// Errors as read_observations.
Result<FileSummary> summarise_file(const std::string& path, const InputOptions& options = {});

// The part that looks at observations alone. REQUIRES: some observations
FileSummary summarise_observations(const ObservationSet& observations);

}  // namespace thin
