#pragma once

// Whole files in memory, by plain system calls so that every failure has its errno.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"

namespace thin {

// Errors: temporary or internal, by errno; input, where `path` is a folder or isn't there.
Result<std::vector<std::uint8_t>> read_file_bytes(const std::string& path);

// Creates or replaces `path`; not synced to disk. Where it fails (temporary: disk full, I/O error), no
// regular file is left.
Result<void> write_file_bytes(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace thin
