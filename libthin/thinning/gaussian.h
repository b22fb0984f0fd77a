#pragma once

#include "libthin/thinning/latitude_longitude_mesh.h"
#include "libthin/thinning/thinning_method.h"

namespace thin {

// One observation per cell of a grid in place and time, as the filter "Gaussian Thinning" of JEDI's UFO: the same
// option names and meanings. category_variable and priority_variable are options of all methods here. O(n).
//
// Cells and centres are UFO's: a sphere of 6371.0 km, geodetic latitudes, times cut off at the first and the last cell.
// UFO computes in single precision, this in double: they may differ on the very edge of a cell, and between two
// observations within about 2 km of equally far from its centre.
//
// Left out, because it means nothing here: vertical_mesh, vertical_min, vertical_max, vertical_coordinate (a sounding
// has no height of its own), select_median, min_num_obs_per_bin and distance_norm = "null" (a median of all channels
// is no observation), records_are_single_obs, retain_only_if_all_filter_variables_are_valid, ignore_existing_qc_flags
// (screening comes before), and ops_compatibility_mode, whose parts are options of their own (its unstable sorting
// cannot be had).
class Gaussian : public ThinningMethod {
 public:
  enum class DistanceNorm { geodesic, maximum };

  void declare_options(OptionTable& table) override;
  Traits traits() const override { return {.stops_at_count = false, .uses_values = false, .uses_places = false}; }
  std::optional<Conflict> conflict() const override;
  // Notes where time_mesh is given without its bounds: time does not count then.
  Result<Choice> choose(const ThinningInput& input) const override;

 private:
  double horizontal_mesh_km_ = 111.19492664455873;  // a degree
  bool use_reduced_horizontal_grid_ = true;
  bool round_horizontal_bin_count_to_nearest_ = false;
  bool partition_longitude_bins_using_mesh_ = false;
  bool define_meridian_20000_km_ = false;
  std::optional<std::string> time_mesh_, time_min_, time_max_;
  DistanceNorm distance_norm_ = DistanceNorm::geodesic;
  bool tiebreaker_pick_latest_ = false;

  struct TimeBins;
  std::optional<TimeBins> time_bins() const;
  LatitudeLongitudeMesh mesh() const;
};

}  // namespace thin
