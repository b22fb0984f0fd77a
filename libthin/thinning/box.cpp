#include "libthin/thinning/box.h"

#include <cmath>
#include <numbers>

#include "libthin/estimation/gme_grid.h"
#include "libthin/estimation/places.h"
#include "libthin/foundation/kd_tree.h"
#include "libthin/foundation/parallel.h"
#include "libthin/observations/geodesy.h"
#include "libthin/thinning/cells.h"
#include "libthin/thinning/latitude_longitude_mesh.h"

namespace thin {
namespace {

void find_boxes(const ObservationSet& observations, double mesh_km, BoxedObservations& cells) {
  using Mesh = LatitudeLongitudeMesh;
  const double meridian_km = std::numbers::pi * kEarthRadiusKm;
  const Mesh mesh = Mesh::reduced(Mesh::rounded(meridian_km / mesh_km, Mesh::Rounding::nearest),
                                  2 * meridian_km / mesh_km, Mesh::Rounding::nearest);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Mesh::Box box = mesh.box_of(observations.latitude_deg[i], observations.longitude_deg[i]);
    cells.cell[i] = mesh.number(box);
    cells.distance_km[i] = chord_km(observations.position_km[i],
                                    geocentric_km(mesh.centre_latitude_deg(box), mesh.centre_longitude_deg(box)));
  }
}

void find_gme_cells(const ObservationSet& observations, int level, BoxedObservations& cells) {
  const KdTree vertices(places_at(gme_grid(level)).coordinates, 3);
  parallel_ranges(observations.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> nearest;
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3& position = observations.position_km[i];
      const double query[] = {position.x, position.y, position.z};
      vertices.nearest(query, 1, nearest);
      cells.cell[i] = nearest.front().index;
      cells.distance_km[i] = std::sqrt(nearest.front().distance_squared);
    }
  });
}

}  // namespace

void BoxOptions::declare(OptionTable& table) {
  table.add_choice(
      "grid", grid,
      std::vector<std::pair<std::string, Grid>>{{"latitude_longitude", Grid::latitude_longitude}, {"gme", Grid::gme}},
      {.explanation = "boxes of nearly equal area between circles of latitude, or cells of the GME grid"});
  table.add("horizontal_mesh", horizontal_mesh_km,
            {.unit = "km",
             .minimum = 0.1,
             .maximum = 20000,
             .explanation = "side of a box, where grid = \"latitude_longitude\""});
  table.add("level", level,
            {.unit = "subdivisions",
             .minimum = 0,
             .maximum = kMaximumGmeLevel,
             .explanation = "of the GME grid, where grid = \"gme\": 10*4^level + 2 cells, 6 is about 112 km"});
}

BoxedObservations::BoxedObservations(const ObservationSet& observations, const BoxOptions& options)
    : cell(observations.size()), distance_km(observations.size()) {
  if (options.grid == BoxOptions::Grid::gme)
    find_gme_cells(observations, options.level, *this);
  else
    find_boxes(observations, options.horizontal_mesh_km, *this);
}

Result<Choice> Box::choose(const ThinningInput& input) const {
  const BoxedObservations boxed(input.observations, boxes_);
  return Choice{nearest_of_each_cell(input, boxed.cell, boxed.distance_km)};
}

}  // namespace thin
