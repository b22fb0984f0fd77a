#pragma once

// The boundary of land and sea out of a netCDF file: GSHHG's shorelines as Debian packages them for GMT
// (/usr/share/gmt-gshhg/binned_GSHHS_[cilhf].nc; Wessel and Smith 1996), or anyone's mask on a grid.
//
// Of GSHHG the shores of land against the ocean are taken (level 1, with Antarctica's ice front): lakes are land, the
// Caspian among them.
//
// A mask is a variable over latitude and longitude (dimensions before them have length 1) whose standard_name is
// land_binary_mask or land_area_fraction, or whose name is land_sea_mask, lsm or land_fraction; from 0.5 on it is land,
// missing is sea. Its two dimensions have coordinate variables in degrees, evenly spaced, that cover the globe.

#include <string>
#include <vector>

#include "libthin/foundation/result.h"
#include "libthin/observations/shore_edge.h"

namespace thin {

// Errors: configuration, where the file is not there or is neither of the two, with the remedy.
Result<std::vector<ShoreEdge>> read_shoreline(const std::string& path);

}  // namespace thin
