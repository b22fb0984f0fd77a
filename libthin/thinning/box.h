#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// One observation per box, the nearest to its centre. The boxes are those of a mesh of latitude bands of equal height,
// each cut into boxes of nearly equal area, or the cells of the GME's icosahedral grid: each vertex with all places
// that are nearer to it than to any other (hexagons, and twelve pentagons). O(n), on the GME grid O((n + 4^level) log).
class Box : public ThinningMethod {
 public:
  enum class Grid { latitude_longitude, gme };

  void declare_options(OptionTable& table) override;
  Traits traits() const override { return {.stops_at_count = false, .uses_values = false, .uses_places = false}; }
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  Grid grid_ = Grid::latitude_longitude;
  double horizontal_mesh_km_ = 75;
  int level_ = 6;
};

}  // namespace thin
