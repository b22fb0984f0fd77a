#include "libthin/analysis/density_difference.h"

#include <cstdlib>
#include <map>
#include <numbers>

#include "libthin/observations/geodesy.h"
#include "libthin/thinning/latitude_longitude_mesh.h"

namespace thin {

std::vector<BoxDifference> density_difference(const ObservationSet& set, std::span<const std::uint32_t> retained,
                                              std::span<const std::uint32_t> reference, double box_km) {
  using Mesh = LatitudeLongitudeMesh;
  const double meridian_km = std::numbers::pi * kEarthRadiusKm;
  const Mesh mesh = Mesh::reduced(Mesh::rounded(meridian_km / box_km, Mesh::Rounding::nearest),
                                  2 * meridian_km / box_km, Mesh::Rounding::nearest);
  std::map<std::uint64_t, BoxDifference> boxes;
  const auto box_of = [&](std::uint32_t i) -> BoxDifference& {
    const Mesh::Box box = mesh.box_of(set.latitude_deg[i], set.longitude_deg[i]);
    return boxes
        .try_emplace(mesh.number(box), BoxDifference{mesh.centre_latitude_deg(box), mesh.centre_longitude_deg(box)})
        .first->second;
  };
  for (std::uint32_t i = 0; i < set.size(); ++i) ++box_of(i).observations;
  for (const std::uint32_t i : retained) ++box_of(i).retained;
  for (const std::uint32_t i : reference) ++box_of(i).reference;
  std::vector<BoxDifference> list;
  for (const auto& [place, box] : boxes) list.push_back(box);
  return list;
}

double mean_absolute_difference(std::span<const BoxDifference> boxes) {
  double sum = 0;
  for (const BoxDifference& box : boxes) sum += std::abs(box.retained - box.reference);
  return boxes.empty() ? 0 : sum / static_cast<double>(boxes.size());
}

}  // namespace thin
