#pragma once

#include "libthin/thinning/thinning_method.h"

namespace thin {

// Observations in random order, each retained unless it lies inside the exclusion volume of one retained before; as the
// filter "Poisson Disk Thinning" of JEDI's UFO: the same option names and meanings. Those of higher priority come
// first; category_variable and priority_variable are options of all methods here. O(n log n + pairs within reach of
// the retained).
//
// Distances are UFO's: on a sphere of 6371.0 km, from geodetic latitudes. What differs: without any
// spacing 100 km is taken (there nothing is thinned then), and random_seed has a default (there it comes from the
// clock, and no two runs give the same).
//
// Left out: spacings that differ by priority (thin by category_variable instead), min_vertical_spacing, sort_vertical
// and the pressure options (a sounding has no height of its own), select_median and write_median (a median of all
// channels is no observation), exclusion_volume_shape = "box" with min_latitude_spacing and min_longitude_spacing (a
// box in degrees shrinks to nothing towards the poles, and ends at the date line).
class PoissonDisk : public ThinningMethod {
 public:
  enum class Shape {
    cylinder,   // nearer than min_horizontal_spacing, and in less than min_time_spacing
    ellipsoid,  // the sum of the squares of both, each in units of its spacing, is less than 1
  };

  void declare_options(OptionTable& table) override;
  Traits traits() const override { return {.stops_at_count = false, .uses_values = false, .uses_places = false}; }
  std::optional<Conflict> conflict() const override;
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  double horizontal_spacing_km() const;

  std::optional<double> min_horizontal_spacing_km_;
  std::optional<std::string> min_time_spacing_;
  Shape shape_ = Shape::cylinder;
  bool shuffle_ = true;
  std::int64_t random_seed_ = 1;
};

}  // namespace thin
