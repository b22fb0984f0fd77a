#pragma once

// Originals of published files, kept as long as the configuration says: without them a window can't be thinned again.

#include <cstdint>
#include <string>

#include "libthin/foundation/result.h"

namespace thind {

// Removes the files that were laid into the folder before that time (wall clock). Returns how many.
thin::Result<int> purge_archive(const std::string& folder, std::int64_t before_ms);

}  // namespace thind
