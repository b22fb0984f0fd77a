#pragma once

// Land, sea or coast for observations whose files do not say.

#include <string>

#include "libthin/foundation/options.h"
#include "libthin/observations/observation_set.h"
#include "libthin/preparation/shoreline.h"

namespace thin {

struct SurfaceOptions {
  std::string land_sea_mask = "/usr/share/gmt-gshhg/binned_GSHHS_l.nc";
  double coast_distance_km = 50;

  void declare(OptionTable& table);
};

// Gives every observation of unknown surface one: coast within this distance of a shore, else land or sea. Lakes are
// land, and so are ice shelves. Returns how many were unknown.
std::size_t fill_surfaces(ObservationSet& observations, const Shoreline& shoreline, double coast_distance_km);

}  // namespace thin
