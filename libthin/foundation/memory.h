#pragma once

// How much memory this process may still take, asked before something large is begun, so that "too large" is a sentence
// with a remedy and not the end of the process.

#include <cstdint>

namespace thin {

// The least of what the machine has available (MemAvailable), what the process's address space limit leaves and what
// its control group leaves; bytes. A very large number where none of them can be read.
std::uint64_t available_memory_bytes();

}  // namespace thin
