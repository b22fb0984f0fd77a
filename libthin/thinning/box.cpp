#include "libthin/thinning/box.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

// Bands of equal height from pole to pole; in each, so many boxes that they come as near to squares as whole numbers
// do.
class BoxMesh {
 public:
  explicit BoxMesh(double mesh_km)
      : mesh_km_(mesh_km),
        bands_(std::max<std::int64_t>(1, std::llround(std::numbers::pi * kEarthRadiusKm / mesh_km))) {}

  struct Box {
    std::int64_t band;
    std::int64_t number;  // eastwards from the Greenwich meridian
  };

  Box box_of(double latitude_deg, double longitude_deg) const {
    const auto place = [](double share, std::int64_t count) {
      return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(share * static_cast<double>(count))), 0,
                                      count - 1);
    };
    const std::int64_t band = place((latitude_deg + 90) / 180, bands_);
    const double east_deg = normalised_longitude_deg(longitude_deg);
    return {band, place((east_deg < 0 ? east_deg + 360 : east_deg) / 360, boxes_in(band))};
  }

  Vector3 centre_km(const Box& box) const {
    return geocentric_km(band_latitude_deg(box.band),
                         (static_cast<double>(box.number) + 0.5) * 360 / static_cast<double>(boxes_in(box.band)));
  }

  std::uint64_t key(const Box& box) const {
    return static_cast<std::uint64_t>(box.band) << 32 | static_cast<std::uint64_t>(box.number);
  }

 private:
  double band_latitude_deg(std::int64_t band) const {
    return -90 + (static_cast<double>(band) + 0.5) * 180 / static_cast<double>(bands_);
  }
  std::int64_t boxes_in(std::int64_t band) const {
    const double circle_km =
        2 * std::numbers::pi * kEarthRadiusKm * std::cos(band_latitude_deg(band) * std::numbers::pi / 180);
    return std::max<std::int64_t>(1, std::llround(circle_km / mesh_km_));
  }

  double mesh_km_;
  std::int64_t bands_;
};

}  // namespace

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
