#pragma once

// Boxes of nearly equal area that cover the Earth: bands of equal height from pole to pole; in each, so many boxes that
// they come as near to squares as whole numbers do.

#include <cstdint>

#include "libthin/observations/observation_set.h"

namespace thin {

class BoxMesh {
 public:
  // REQUIRES: mesh_km > 0, the side of a box
  explicit BoxMesh(double mesh_km);

  struct Box {
    std::int64_t band;                             // from the south pole
    std::int64_t number;                           // eastwards from the Greenwich meridian
    auto operator<=>(const Box&) const = default;  // NOLINT(modernize-use-nullptr): mistaken by clang-tidy 14
  };

  Box box_of(double latitude_deg, double longitude_deg) const;
  Vector3 centre_km(const Box& box) const;
  double centre_latitude_deg(const Box& box) const;
  double centre_longitude_deg(const Box& box) const;  // 0..360

  // Different for each box.
  std::uint64_t key(const Box& box) const {
    return static_cast<std::uint64_t>(box.band) << 32 | static_cast<std::uint64_t>(box.number);
  }

 private:
  std::int64_t boxes_in(std::int64_t band) const;

  double mesh_km_;
  std::int64_t bands_;
};

}  // namespace thin
