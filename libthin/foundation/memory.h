#pragma once

// How much memory this process may still take, asked before something large is begun, so that "too large" is a sentence
// with a remedy and not the end of the process.

#include <cstdint>
#include <optional>

namespace thin {

// The least of what the machine has available (MemAvailable), what the process's address space limit leaves and what
// its control group leaves; bytes. A very large number where none of them can be read.
std::uint64_t available_memory_bytes();

// The most that this process holds in memory from here on, above what it holds now. One at a time: the kernel keeps one
// mark for the process.
class PeakMemory {
 public:
  PeakMemory();
  // Nothing where the kernel does not say (it does on Linux).
  std::optional<std::uint64_t> bytes_above_start() const;

 private:
  std::optional<std::uint64_t> start_bytes_;
};

}  // namespace thin
