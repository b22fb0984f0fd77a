#include "libthin/thinning/grid_eea.h"

#include "libthin/estimation/gme_grid.h"

namespace thin {

void GridEea::declare_options(OptionTable& table) {
  target_.declare_options(table);
  table.add("bandwidth_km", bandwidth_km_,
            {.unit = "km", .maximum = 5000, .above = 0, .explanation = "h of the Gaussian filter, cut off at 3h"});
  table.add("level", level_,
            {.unit = "subdivisions",
             .minimum = 0,
             .maximum = kMaximumGmeLevel,
             .explanation = "of the GME grid that the error is taken on: 10*4^level + 2 vertices, 6 is about 112 km"});
  table.add_choice(
      "update", update_, std::vector<std::pair<std::string, Update>>{{"full", Update::full}, {"lazy", Update::lazy}},
      {.explanation = "full: each step is the exact greedy choice; lazy: increments are recomputed only at "
                      "the front of the queue"});
}

Result<Retained> GridEea::thin(const ObservationSet& observations) const {
  if (Result<void> finite = require_finite_values(observations); !finite) return finite.error();
  const std::vector<Vector3> grid = gme_grid(level_);
  Result<NeighbourhoodTable> table = neighbourhood_table(grid, observations.position_km, {bandwidth_km_});
  if (!table) return table.error();
  RemovalSums sums(std::move(*table), observations.values, observations.channel_count());
  return remove_greedily(sums, target_.count_of(observations.size()), update_);
}

}  // namespace thin
