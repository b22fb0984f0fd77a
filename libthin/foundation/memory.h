#pragma once

// How much memory this process may still take, asked before something large is begun, so that "too large" is a sentence
// with a remedy and not the end of the process.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace thin {

// The least of what the machine has available (MemAvailable), what the process's address space limit leaves and what
// its control group leaves; bytes. A very large number where none of them can be read.
std::uint64_t available_memory_bytes();

// Asks the system to back this memory with large pages, where it offers them on request. For arrays of many megabytes
// that are read here and there, so that the translation of addresses does not cost more than the reading.
void advise_large_pages(void* begin, std::size_t bytes);

// values.assign(count, value) into large pages.
template <class T>
void assign_in_large_pages(std::vector<T>& values, std::size_t count, const T& value = {}) {
  values.reserve(count);
  advise_large_pages(values.data(), count * sizeof(T));
  values.assign(count, value);
}

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
