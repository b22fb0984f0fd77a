// Any bytes as a netCDF file, by the same functions as the worker calls: read, and the retained half written again, as
// a subset and with flags. What was written must be read again, with as many observations.

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "libthin/formats/netcdf_layout.h"
#include "libthin/foundation/file_bytes.h"

namespace {

using Bytes = std::span<const std::uint8_t>;

void require(bool holds, const char* what, const std::string& detail = "") {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s (%s)\n", what, detail.c_str());
  std::abort();
}

void check_reason(const thin::Error& error) {
  require(!error.message.empty(), "a reason");
  require(error.kind != thin::ErrorKind::internal, "an error of the input's, or for want of memory", error.message);
}

void check_sound(const thin::ReadObservations& contents) {
  const thin::ObservationSet& set = contents.observations;
  require(set.size() > 0, "some observations");
  require(set.values.size() == set.size() * set.channels.size(), "a row of values for each observation");
  require(set.first_guess_k.empty() || set.first_guess_k.size() == set.values.size(), "a whole first guess");
  for (const auto& [name, column] : set.variables) require(column.size() == set.size(), "whole variables");
  for (std::size_t i = 0; i < set.size(); ++i) {
    require(std::abs(set.latitude_deg[i]) <= 90, "latitude");
    require(set.longitude_deg[i] >= -180 && set.longitude_deg[i] <= 360, "longitude");
  }
}

void check_output(Bytes bytes, const thin::ObservationSet& set, thin::OutputOptions::Mode mode) {
  static const std::string path = "/dev/shm/thin.fuzz." + std::to_string(::getpid());
  std::vector<thin::SourceReference> retained;
  for (std::size_t i = 0; i < set.size(); i += 2) retained.push_back(set.source[i]);
  thin::OutputOptions options;
  options.mode = mode;
  const auto summary = thin::extract_netcdf(bytes, "fuzz", retained, path, options);
  const auto written = thin::read_file_bytes(path);
  ::unlink(path.c_str());
  // Other variables than those that are read may be damaged.
  if (!summary) return check_reason(summary.error());
  require(written.ok() && written->size() == summary->bytes, "what was written is there");
  const auto again = thin::read_netcdf(*written, "again", {});
  require(again.ok(), "what was written can be read", again ? "" : again.error().message);
  const std::size_t wanted = mode == thin::OutputOptions::Mode::subset ? retained.size() : set.size();
  require(again->observations.size() == wanted, "as many observations as were retained");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, size);
  const auto contents = thin::read_netcdf(bytes, "fuzz", {});
  if (!contents) {
    check_reason(contents.error());
    return 0;
  }
  check_sound(*contents);
  check_output(bytes, contents->observations, thin::OutputOptions::Mode::subset);
  check_output(bytes, contents->observations, thin::OutputOptions::Mode::flag);
  return 0;
}
