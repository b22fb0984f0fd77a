#include "libthin/formats/netcdf_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <vector>

#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

std::vector<const NetcdfLayout*> layouts() {
  return {&gsi_layout(), &feedback_layout(), &ioda_layout(), &cf_layout()};
}

// "its variables are Location", a few of them.
std::string described(const NetcdfFile& file) {
  std::vector<std::string> paths;
  for (const auto& [path, variable] : file.variables()) {
    if (paths.size() == 5) {
      paths.emplace_back("...");
      break;
    }
    paths.push_back(path);
  }
  return paths.empty() ? "there is no variable in it" : fmt::format("its variables are {}", fmt::join(paths, ", "));
}

// Error input, for a file in none of the layouts.
Result<const NetcdfLayout*> layout_of(const NetcdfFile& file) {
  for (const NetcdfLayout* layout : layouts())
    if (layout->recognises(file)) return layout;
  return Error{ErrorKind::input,
               fmt::format("{}: netCDF or HDF5 without soundings in a layout that is read here: {}. Send IODA, GSI "
                           "diagnostics, feedback files, or CF as docs/formats.md describes it.",
                           file.name(), described(file))};
}

// Reads back what was written: the layout, and as many locations as were to be written.
Result<void> check_written(const NetcdfLayout& layout, const std::string& path, const NetcdfEdit& edit) {
  const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(path);
  if (!bytes) return bytes.error();
  const Result<NetcdfFile> file = NetcdfFile::open(*bytes, path);
  if (!file) return Error{ErrorKind::internal, file.error().message};
  const bool recognised = layout.recognises(*file);
  const std::size_t locations = recognised ? layout.locations(*file) : 0;
  if (locations == edit.locations) return {};
  return Error{ErrorKind::internal,
               fmt::format("{}: wrote {} locations, but read back {}", path, edit.locations, locations)};
}

// The retained locations, ascending.
std::vector<std::uint32_t> locations_of(std::span<const SourceReference> retained) {
  std::vector<std::uint32_t> locations;
  for (const SourceReference& reference : retained) locations.push_back(reference.subset);
  std::sort(locations.begin(), locations.end());
  assert(std::adjacent_find(locations.begin(), locations.end()) == locations.end());
  return locations;
}

}  // namespace

Result<ReadObservations> read_netcdf(std::span<const std::uint8_t> bytes, const std::string& name,
                                     const InputOptions& options) {
  const Result<NetcdfFile> file = NetcdfFile::open(bytes, name);
  if (!file) return file.error();
  const Result<const NetcdfLayout*> layout = layout_of(*file);
  if (!layout) return layout.error();
  return (*layout)->read(*file, options);
}

Result<ExtractionSummary> extract_netcdf(std::span<const std::uint8_t> bytes, const std::string& name,
                                         std::span<const SourceReference> retained, const std::string& output_path,
                                         const OutputOptions& options) {
  const bool flag = options.mode == OutputOptions::Mode::flag;
  if (retained.empty() && !flag) return ExtractionSummary{};
  const Result<NetcdfFile> file = NetcdfFile::open(bytes, name);
  if (!file) return file.error();
  const Result<const NetcdfLayout*> layout = layout_of(*file);
  if (!layout) return layout.error();
  const std::vector<std::uint32_t> locations = locations_of(retained);
  const Result<NetcdfEdit> edit =
      flag ? (*layout)->flag(*file, locations, options) : (*layout)->subset(*file, locations, options);
  if (!edit) return edit.error();

  Result<std::vector<std::uint8_t>> image = changes_nothing(*file, *edit)
                                                ? std::vector<std::uint8_t>(bytes.begin(), bytes.end())
                                                : rewrite_netcdf(*file, *edit, output_path);
  if (!image) return image.error();
  if (const Result<void> written = write_file_bytes(output_path, *image); !written) return written.error();
  const Result<void> right = check_written(**layout, output_path, *edit);
  if (!right) return right.error();
  return ExtractionSummary{1, locations.size(), image->size()};
}

}  // namespace thin
