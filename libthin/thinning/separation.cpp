#include "libthin/thinning/separation.h"

#include "libthin/foundation/kd_tree.h"

namespace thin {

Separation::Separation(std::span<const Vector3> positions_km, double min_separation_km) {
  if (min_separation_km <= 0) return;
  std::vector<double> coordinates;
  coordinates.reserve(positions_km.size() * 3);
  for (const Vector3& p : positions_km) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  const KdTree tree(coordinates, 3);
  begin_.push_back(0);
  std::vector<Neighbour> found;
  for (std::uint32_t p = 0; p < positions_km.size(); ++p) {
    tree.radius_search(std::span(coordinates).subspan(3 * std::size_t{p}, 3), min_separation_km, found);
    for (const Neighbour& neighbour : found)
      if (neighbour.index != p && neighbour.distance_squared < min_separation_km * min_separation_km)
        near_.push_back(neighbour.index);
    begin_.push_back(near_.size());
  }
}

}  // namespace thin
