#pragma once

// The one place that recognises what a file is, by its bytes.

#include <cstdint>
#include <span>
#include <string>

#include "libthin/foundation/result.h"

namespace thin {

enum class FileLayout { empty, bufr, netcdf, grib, unknown };

FileLayout layout_of(std::span<const std::uint8_t> bytes);

// The error for a file whose layout has no reader. Incomplete for an empty one: it may not have been written yet.
// REQUIRES: neither bufr nor netcdf
Error refusal(FileLayout layout, std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace thin
