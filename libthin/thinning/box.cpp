#include "libthin/thinning/box.h"

#include <algorithm>
#include <unordered_map>

#include "libthin/observations/box_mesh.h"
#include "libthin/observations/geodesy.h"

namespace thin {

void Box::declare_options(OptionTable& table) {
  table.add("horizontal_mesh", horizontal_mesh_km_,
            {.unit = "km", .minimum = 0.1, .maximum = 20000, .explanation = "side of a box"});
}

Result<Choice> Box::choose(const ThinningInput& input) const {
  const ObservationSet& observations = input.observations;
  struct Nearest {
    std::uint32_t observation;
    double distance_km;
  };
  const BoxMesh mesh(horizontal_mesh_km_);
  std::unordered_map<std::uint64_t, Nearest> nearest;
  for (std::uint32_t i = 0; i < observations.size(); ++i) {
    const BoxMesh::Box box = mesh.box_of(observations.latitude_deg[i], observations.longitude_deg[i]);
    const double distance_km = chord_km(observations.position_km[i], mesh.centre_km(box));
    const auto [place, is_first] = nearest.try_emplace(mesh.key(box), Nearest{i, distance_km});
    if (is_first || input.has_priority(place->second.observation, i)) continue;
    if (input.has_priority(i, place->second.observation) || distance_km < place->second.distance_km)
      place->second = {i, distance_km};
  }
  Retained retained;
  for (const auto& entry : nearest) retained.push_back(entry.second.observation);
  std::sort(retained.begin(), retained.end());
  return Choice{retained};
}

}  // namespace thin
