#pragma once

namespace thin {

// A piece of the boundary between land and sea, straight in latitude and longitude, less than 180 degrees long in
// longitude. Longitudes in any turn.
struct ShoreEdge {
  double from_latitude_deg, from_longitude_deg;
  double to_latitude_deg, to_longitude_deg;
  bool is_shore = true;  // false: where a map of land ends at the pole; closes the land, but no coast is there
};

}  // namespace thin
