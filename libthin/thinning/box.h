#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// The cells of box thinning.
struct BoxOptions {
  enum class Grid { latitude_longitude, gme };
  Grid grid = Grid::latitude_longitude;
  double horizontal_mesh_km = 75;
  int level = 6;

  void declare(OptionTable& table);
};

struct BoxedObservations {
  std::vector<std::uint64_t> cell;
  std::vector<double> distance_km;  // to the cell's centre

  BoxedObservations(const ObservationSet& observations, const BoxOptions& options);
};

// One observation per box, the nearest to its centre. The boxes are those of a mesh of latitude bands of equal height,
// each cut into boxes of nearly equal area, or the cells of the GME's icosahedral grid: each vertex with all places
// that are nearer to it than to any other (hexagons, and twelve pentagons). O(n), on the GME grid O((n + 4^level) log).
class Box : public ThinningMethod {
 public:
  void declare_options(OptionTable& table) override { boxes_.declare(table); }
  Traits traits() const override { return {.stops_at_count = false, .uses_values = false, .uses_places = false}; }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  BoxOptions boxes_;
};

}  // namespace thin
