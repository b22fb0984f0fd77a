#include "libthin/preparation/surface.h"

#include <algorithm>

#include "libthin/foundation/parallel.h"

namespace thin {

void SurfaceOptions::declare(OptionTable& table) {
  table.add("land_sea_mask", land_sea_mask,
            {.explanation = "where `surface` is asked for and a file does not hold it: GSHHG's shorelines (Debian's "
                            "gmt-gshhg-low; finer: -high, -full) or a netCDF mask (docs/operations.md)"});
  table.add("coast_distance_km", coast_distance_km,
            {.unit = "km",
             .minimum = 0,
             .maximum = 1000,
             .explanation = "within this distance of a shore the surface is coast: about the radius of a footprint"});
}

std::size_t fill_surfaces(ObservationSet& set, const Shoreline& shoreline, double coast_distance_km) {
  const auto unknown = std::count(set.surface.begin(), set.surface.end(), Surface::unknown);
  parallel_ranges(set.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (set.surface[i] != Surface::unknown) continue;
      if (shoreline.is_near(set.position_km[i], coast_distance_km))
        set.surface[i] = Surface::coast;
      else
        set.surface[i] = shoreline.is_land(set.latitude_deg[i], set.longitude_deg[i]) ? Surface::land : Surface::sea;
    }
  });
  return static_cast<std::size_t>(unknown);
}

}  // namespace thin
