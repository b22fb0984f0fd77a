#pragma once

// Whether a netCDF file has arrived whole, from its first bytes and its length alone.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/foundation/result.h"

namespace thin {

// The superblock of HDF5 states where the file ends. Error incomplete, where it is shorter. Says nothing about netCDF's
// classic formats, nor about damage.
Result<void> check_netcdf_end(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace thin
