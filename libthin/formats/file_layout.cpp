#include "libthin/formats/file_layout.h"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <string_view>

#include "libthin/formats/gts_bulletin.h"

namespace thin {
namespace {

constexpr std::string_view kHdf5Signature("\x89HDF\r\n\x1a\n", 8);
constexpr std::string_view kReads =
    "Read are BUFR with soundings, and netCDF: IODA, GSI diagnostics, feedback files, CF.";

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// "first bytes 50 4b 03 04"
std::string first_bytes(std::span<const std::uint8_t> bytes) {
  std::string text = "first bytes";
  for (const std::uint8_t byte : bytes.first(std::min<std::size_t>(bytes.size(), 8))) {
    char digits[8];
    std::snprintf(digits, sizeof digits, " %02x", byte);
    text += digits;
  }
  return text;
}

}  // namespace

FileLayout layout_of(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return FileLayout::empty;
  const std::string_view text = text_of(bytes);
  if (text.starts_with(kHdf5Signature)) return FileLayout::netcdf;
  if (text.size() >= 4 && text.starts_with("CDF") && (text[3] == 1 || text[3] == 2 || text[3] == 5))
    return FileLayout::netcdf;
  if (text.starts_with("GRIB")) return FileLayout::grib;
  // A transfer may have come no further than the first letters, or the heading in front of them.
  const bool begins_like_bufr = std::string_view("BUFR").starts_with(text.substr(0, 4));
  if (begins_like_bufr || is_cut_gts_heading(bytes) || text.find("BUFR") != std::string_view::npos)
    return FileLayout::bufr;
  return FileLayout::unknown;
}

Error refusal(FileLayout layout, std::span<const std::uint8_t> bytes, const std::string& name) {
  assert(layout != FileLayout::bufr && layout != FileLayout::netcdf);
  const std::string reads(kReads);
  switch (layout) {
    case FileLayout::empty:
      return {ErrorKind::incomplete, name + ": the file is empty. Wait for its bytes, or ask the sender for it again."};
    case FileLayout::grib:
      return {ErrorKind::input, name + ": a GRIB file holds fields, not soundings. " + reads};
    default:
      return {ErrorKind::input, name + ": no BUFR message in it, nor netCDF (" + first_bytes(bytes) + "). " + reads};
  }
}

}  // namespace thin
