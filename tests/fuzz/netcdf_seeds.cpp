// Files to begin with, small ones of every layout and format, written by the tests' own writers: seeds_netcdf FOLDER
//
// HDF5's newer files guard their metadata by checksums, over which a search doesn't get; netCDF's images in memory are
// in HDF5's older format, which has none. So there is a seed of that kind too.

#include <netcdf.h>
#include <netcdf_mem.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/netcdf_files.h"

namespace {

void put(int group, const char* name, int type, const std::vector<int>& dimensions, const std::vector<double>& values,
         bool packed) {
  int variable = 0;
  nc_def_var(group, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable);
  const std::vector<std::size_t> chunks(dimensions.size(), 2);
  if (packed) nc_def_var_chunking(group, variable, NC_CHUNKED, chunks.data());
  if (packed) nc_def_var_deflate(group, variable, 1, 1, 1);
  nc_put_var_double(group, variable, values.data());
}

void write_ioda_without_checksums(const std::string& path, bool packed) {
  int file = 0, location = 0, channel = 0, metadata = 0, observed = 0, guess = 0;
  nc_create_mem("seed", NC_NETCDF4, 1 << 16, &file);
  nc_def_dim(file, "Location", 3, &location);
  nc_def_dim(file, "Channel", 2, &channel);
  nc_put_att_text(file, NC_GLOBAL, "_ioda_layout", 8, "ObsGroup");
  nc_def_grp(file, "MetaData", &metadata);
  put(metadata, "latitude", NC_FLOAT, {location}, {10, 11, 12}, packed);
  put(metadata, "longitude", NC_FLOAT, {location}, {20, 21, 22}, packed);
  put(metadata, "dateTime", NC_INT64, {location}, {1, 2, 3}, packed);
  int time = 0;
  nc_inq_varid(metadata, "dateTime", &time);
  nc_put_att_text(metadata, time, "units", 33, "seconds since 1970-01-01T00:00:00");
  nc_def_grp(file, "ObsValue", &observed);
  put(observed, "brightnessTemperature", NC_FLOAT, {location, channel}, {200, 210, 201, 211, 202, 212}, packed);
  nc_def_grp(file, "hofx", &guess);
  put(guess, "brightnessTemperature", NC_FLOAT, {location, channel}, {201, 211, 200, 211, 202, 214}, packed);
  NC_memio image = {};
  nc_close_memio(file, &image);
  std::ofstream(path, std::ios::binary).write(static_cast<const char*>(image.memory), static_cast<long>(image.size));
  std::free(image.memory);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("seeds_netcdf FOLDER\n", stderr);
    return 2;
  }
  using namespace thin::test;
  int count = 0;
  const auto next = [&] { return std::string(argv[1]) + "/seed" + std::to_string(++count); };
  write_ioda(next(), {.locations = 3, .channels = 2});
  write_ioda(next(), {.locations = 3, .channels = 2, .unlimited = false});
  write_old_ioda(next(), true, 3, 2);
  write_old_ioda(next(), false, 3, 2);
  write_gsi(next(), 3, 2);
  for (const char* kind : {"nc3", "64-bit offset", "cdf5", "nc7"})
    write_feedback(next(), {.reports = 6, .channels = 2, .unused_headers = 1, .unused_bodies = 2, .kind = kind});
  write_foreign_cf(next(), 3, 2);
  write_ioda_without_checksums(next(), false);
  write_ioda_without_checksums(next(), true);
  std::printf("%d seeds\n", count);
}
