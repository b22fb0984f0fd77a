#pragma once

// Whether a netCDF file has arrived whole, from what its header states and its length alone.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/foundation/result.h"

namespace thin {

// HDF5's superblock states where the file ends; in netCDF's classic formats (CDF-1, -2, -5) the header says where each
// variable begins and how long it is. Errors: incomplete, where the file is shorter; input, where a classic header
// makes no sense, which netCDF-C does not survive in every case. Damage elsewhere is left to netCDF.
Result<void> check_netcdf_end(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace thin
