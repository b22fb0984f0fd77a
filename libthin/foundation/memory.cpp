#include "libthin/foundation/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace thin {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> first_number_in(const std::string& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

std::uint64_t left_by_the_machine() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  std::uint64_t kilobytes = 0;
  for (std::string unit; file >> name >> kilobytes && std::getline(file, unit);)
    if (name == "MemAvailable:") return kilobytes * 1024;
  return kUnlimited;
}

std::uint64_t left_by_the_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const std::uint64_t pages = first_number_in("/proc/self/statm").value_or(0);
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

// Control groups of version 2, as seen from inside of one.
std::uint64_t left_by_the_control_group() {
  const auto most = first_number_in("/sys/fs/cgroup/memory.max");
  const auto used = first_number_in("/sys/fs/cgroup/memory.current");
  if (!most || !used) return kUnlimited;
  return *most > *used ? *most - *used : 0;
}

std::optional<std::uint64_t> process_status_bytes(const std::string& field) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(field + ":")) return std::stoull(line.substr(field.size() + 1)) * 1024;
  return std::nullopt;
}

}  // namespace

PeakMemory::PeakMemory() {
  malloc_trim(0);  // what is free already would hide what is taken next
  std::ofstream mark("/proc/self/clear_refs");
  if (mark << 5 << std::flush) start_bytes_ = process_status_bytes("VmRSS");
}

std::optional<std::uint64_t> PeakMemory::bytes_above_start() const {
  const auto peak = process_status_bytes("VmHWM");
  if (!start_bytes_ || !peak) return std::nullopt;
  return *peak > *start_bytes_ ? *peak - *start_bytes_ : 0;
}

std::uint64_t available_memory_bytes() {
  return std::min({left_by_the_machine(), left_by_the_address_space(), left_by_the_control_group()});
}

void advise_large_pages(void* begin, std::size_t bytes) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + page - 1) / page * page, last = (address + bytes) / page * page;
  // Advice: where it is not taken, nothing is lost.
  if (last > first) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}

}  // namespace thin
