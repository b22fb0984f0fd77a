#pragma once

// The globe in bands of equal height in latitude, from the South Pole on, each cut into boxes of equal width in
// longitude, from the Greenwich meridian eastwards.

#include <cstdint>
#include <vector>

namespace thin {

class LatitudeLongitudeMesh {
 public:
  enum class Rounding { down, nearest };

  // As many boxes in every band. REQUIRES: bands, boxes >= 1
  static LatitudeLongitudeMesh regular(std::int64_t bands, std::int64_t boxes);

  // So many boxes around the equator, fewer towards the poles, by the cosine of each band's middle; at least one.
  // REQUIRES: bands >= 1
  static LatitudeLongitudeMesh reduced(std::int64_t bands, double boxes_around_equator, Rounding rounding);

  // At least 1. What is whole but for rounding errors counts as whole.
  static std::int64_t rounded(double count, Rounding rounding);

  struct Box {
    std::int64_t band;
    std::int64_t place;  // in its band
  };

  // Longitude in any turn; -30 and 330 give the same box. REQUIRES: -90 <= latitude_deg <= 90
  Box box_of(double latitude_deg, double longitude_deg) const;

  double centre_latitude_deg(const Box& box) const {
    return -90 + (static_cast<double>(box.band) + 0.5) * height_deg();
  }
  double centre_longitude_deg(const Box& box) const { return (static_cast<double>(box.place) + 0.5) * width_deg(box); }
  double height_deg() const { return 180 / static_cast<double>(band_count()); }
  double width_deg(const Box& box) const { return 360 / static_cast<double>(boxes_in(box.band)); }

  // Each box has a number of its own, 0 .. box_count()-1.
  std::uint64_t number(const Box& box) const { return first_[static_cast<std::size_t>(box.band)] + box.place; }
  std::uint64_t box_count() const { return first_.back(); }

 private:
  explicit LatitudeLongitudeMesh(std::int64_t bands) : first_(static_cast<std::size_t>(bands) + 1, 0) {}

  std::int64_t band_count() const { return static_cast<std::int64_t>(first_.size()) - 1; }
  std::int64_t boxes_in(std::int64_t band) const {
    const auto place = static_cast<std::size_t>(band);
    return static_cast<std::int64_t>(first_[place + 1] - first_[place]);
  }

  std::vector<std::uint64_t> first_;  // number of the first box of each band; then of all
};

}  // namespace thin
