#pragma once

// Files that appear whole or not at all, whatever dies when.

#include <string>

#include "libthin/foundation/result.h"

namespace thin {

// Syncs `temporary`, renames it to `path` (replacing what is there), and syncs the folder. REQUIRES: one file system
Result<void> publish_file(const std::string& temporary, const std::string& path);

// Writes text to `path` by way of a hidden temporary file beside it.
Result<void> write_text_atomically(const std::string& path, const std::string& text);

}  // namespace thin
