#pragma once

// Soundings as CF discrete sampling, featureType "point": netCDF-4 that xarray, ncdump and anything else opens, and
// that the reader of the layout "cf" takes for what they are. docs/formats.md documents it, name by name.

#include <cstdint>
#include <string>

#include "libthin/foundation/result.h"
#include "libthin/observations/observation_set.h"

namespace thin {

// The file appears whole or not at all (atomic_file.h); the same observations give the same bytes. Returns its size.
// Temperatures, first guess and further variables are stored as float, with NaN as _FillValue; a first guess and
// variables are there where the observations have them.
// REQUIRES: observations of one instrument, at least one
Result<std::uint64_t> write_cf_file(const std::string& path, const ObservationSet& observations);

}  // namespace thin
