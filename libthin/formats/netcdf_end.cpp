#include "libthin/formats/netcdf_end.h"

#include <optional>
#include <string_view>

namespace thin {
namespace {

constexpr std::string_view kHdf5Signature("\x89HDF\r\n\x1a\n", 8);

// Little-endian, as all of HDF5's own numbers are. REQUIRES: they are there
std::uint64_t little_endian(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | bytes[offset + i];
  return value;
}

// The end that the superblock states (HDF5 file format specification, II.A); nothing where it has none that can be
// read.
std::optional<std::uint64_t> stated_end(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kVersion = 8, kLongestSuperblock = 96;
  if (bytes.size() < kLongestSuperblock) return std::nullopt;
  const int version = bytes[kVersion];
  if (version > 3) return std::nullopt;
  const std::size_t offset_size = bytes[version < 2 ? 13 : 9];
  if (offset_size != 4 && offset_size != 8) return std::nullopt;
  // Base address, one other address, end of file.
  const std::size_t addresses = version == 0 ? 24 : version == 1 ? 28 : 12;
  return little_endian(bytes, addresses + 2 * offset_size, offset_size);
}

}  // namespace

Result<void> check_netcdf_end(std::span<const std::uint8_t> bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(kHdf5Signature)) return {};
  const std::optional<std::uint64_t> end = stated_end(bytes);
  const bool cut_superblock = bytes.size() < 96;
  if (!cut_superblock && (!end || *end <= bytes.size())) return {};
  return Error{ErrorKind::incomplete, name + ": the file is cut: it has " + std::to_string(bytes.size()) + " of " +
                                          (end ? std::to_string(*end) : std::string("at least 96")) +
                                          " bytes. Wait for the rest, or ask the sender for it again."};
}

}  // namespace thin
