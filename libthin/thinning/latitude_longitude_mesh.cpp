#include "libthin/thinning/latitude_longitude_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "libthin/observations/geodesy.h"

namespace thin {
namespace {

// Which of so many equal parts a share of the whole lies in; its end belongs to the last.
std::int64_t part_of(double share, std::int64_t count) {
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(share * static_cast<double>(count)), 0, count - 1);
}

}  // namespace

LatitudeLongitudeMesh LatitudeLongitudeMesh::regular(std::int64_t bands, std::int64_t boxes) {
  assert(bands >= 1 && boxes >= 1);
  LatitudeLongitudeMesh mesh(bands);
  for (std::size_t band = 1; band < mesh.first_.size(); ++band)
    mesh.first_[band] = band * static_cast<std::uint64_t>(boxes);
  return mesh;
}

LatitudeLongitudeMesh LatitudeLongitudeMesh::reduced(std::int64_t bands, double boxes_around_equator,
                                                     Rounding rounding) {
  assert(bands >= 1);
  LatitudeLongitudeMesh mesh(bands);
  for (std::int64_t band = 0; band < bands; ++band) {
    const double latitude = mesh.centre_latitude_deg({band, 0}) * std::numbers::pi / 180;
    const auto place = static_cast<std::size_t>(band);
    mesh.first_[place + 1] =
        mesh.first_[place] + static_cast<std::uint64_t>(rounded(boxes_around_equator * std::cos(latitude), rounding));
  }
  return mesh;
}

std::int64_t LatitudeLongitudeMesh::rounded(double count, Rounding rounding) {
  const double whole = rounding == Rounding::nearest ? std::round(count) : std::floor(count * (1 + 1e-12));
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(whole));
}

LatitudeLongitudeMesh::Box LatitudeLongitudeMesh::box_of(double latitude_deg, double longitude_deg) const {
  const std::int64_t band = part_of((latitude_deg + 90) / 180, band_count());
  const double longitude = normalised_longitude_deg(longitude_deg);
  return {band, part_of((longitude < 0 ? longitude + 360 : longitude) / 360, boxes_in(band))};
}

}  // namespace thin
