#pragma once

#include <string>

#include "libemap/coding/stream.h"
#include "libthin/foundation/result.h"

namespace emap {

// Reads and decodes a file; errors name it.
thin::Result<DecodedStream> read_emap_file(const std::string& path);

}  // namespace emap
