#pragma once

// One field of view that arrived twice: by direct readout from several stations (RARS, EARS) beside the global data, or
// the same message sent again. It counts once in an analysis, so one of them is kept.
//
// Two observations are duplicates where satellite, instrument and field of view are the same and they lie within 10 km
// and 6 minutes of each other (the limits that centres use for RARS data). Fields of view of one swath are farther
// apart than that, along the track and across.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// What makes one duplicate better than another. The first rule in which two differ decides, at last the canonical
// order.
enum class DuplicatePreference {
  file_order,      // whose file name matches an earlier pattern of file_order; files that match none come last
  fewest_missing,  // with fewer missing channels
  earliest,        // of the earlier time
  latest,
};

struct DuplicateOptions {
  bool remove = true;
  double distance_km = 10;
  double minutes = 6;
  std::vector<DuplicatePreference> preference = {DuplicatePreference::file_order, DuplicatePreference::fewest_missing,
                                                 DuplicatePreference::earliest};
  std::vector<std::string> file_order;  // patterns with * and ?, the best first

  void declare(OptionTable& table);

 private:
  std::vector<std::string> preference_names_ = {"file_order", "fewest_missing", "earliest"};
};

enum class Duplicate : std::uint8_t {
  none,   // kept
  near,   // another observation of the same field of view is kept
  exact,  // as near, and equal in time, position, scan line and every value
};

// For each observation what it is; all none where options.remove is false. The best is taken, its duplicates go, then
// the best of the rest, and so on: no two that are kept are duplicates of each other, and what goes lies near what is
// kept. file_names[i] is that of source.file == i; there may be none. Observations in canonical order give the same
// choice whatever the order of arrival. O(n log n).
std::vector<Duplicate> find_duplicates(const ObservationSet& observations, std::span<const std::string> file_names,
                                       const DuplicateOptions& options);

}  // namespace thin
