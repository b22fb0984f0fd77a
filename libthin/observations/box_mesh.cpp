#include "libthin/observations/box_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

// Which of `count` equal parts `share` of the whole falls into.
std::int64_t part_of(double share, std::int64_t count) {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(share * static_cast<double>(count))), 0,
                                  count - 1);
}

}  // namespace

BoxMesh::BoxMesh(double mesh_km)
    : mesh_km_(mesh_km), bands_(std::max<std::int64_t>(1, std::llround(std::numbers::pi * kEarthRadiusKm / mesh_km))) {}

BoxMesh::Box BoxMesh::box_of(double latitude_deg, double longitude_deg) const {
  const std::int64_t band = part_of((latitude_deg + 90) / 180, bands_);
  const double east_deg = normalised_longitude_deg(longitude_deg);
  return {band, part_of((east_deg < 0 ? east_deg + 360 : east_deg) / 360, boxes_in(band))};
}

Vector3 BoxMesh::centre_km(const Box& box) const {
  return geocentric_km(centre_latitude_deg(box), centre_longitude_deg(box));
}

double BoxMesh::centre_latitude_deg(const Box& box) const {
  return -90 + (static_cast<double>(box.band) + 0.5) * 180 / static_cast<double>(bands_);
}

double BoxMesh::centre_longitude_deg(const Box& box) const {
  return (static_cast<double>(box.number) + 0.5) * 360 / static_cast<double>(boxes_in(box.band));
}

std::int64_t BoxMesh::boxes_in(std::int64_t band) const {
  const double circle_km =
      2 * std::numbers::pi * kEarthRadiusKm * std::cos(centre_latitude_deg({band, 0}) * std::numbers::pi / 180);
  return std::max<std::int64_t>(1, std::llround(circle_km / mesh_km_));
}

}  // namespace thin
