#pragma once

// A netCDF file written again with fewer entries along some of its dimensions, and nothing else changed: every group,
// dimension, type, variable, attribute, fill value, byte order, chunking and filter stays, in the format of the
// original. Values go through as they are stored, never through another type.
//
// What netCDF-C does not let a program choose differs: the version of HDF5's superblock, and the note of the library
// that wrote the file (_NCProperties); texts and values of types of the file's own are not compressed, which netCDF
// refuses from 4.9 on. A chunk that is longer than its shrunken dimension becomes as short as that.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "libthin/formats/netcdf_file.h"
#include "libthin/foundation/result.h"

namespace thin {

// A variable of integers that the original lacks.
struct AddedVariable {
  std::string path;  // "ThinningQC/brightnessTemperature"; the group is made where there is none
  std::string like;  // path of the variable whose dimensions, chunking and compression it gets
  std::vector<int> values;
  std::vector<int> flag_values;  // as the attribute, in CF's sense
  std::vector<std::pair<std::string, std::string>> attributes;
};

// What the new file differs in.
struct NetcdfEdit {
  // By netCDF's number of the dimension: the entries that stay, ascending. Other dimensions stay whole.
  std::map<int, std::vector<std::uint32_t>> kept;
  // By path: the values of variables of numbers in place of the original's, as they are to be stored, in the new size.
  std::map<std::string, std::vector<double>> replaced;
  std::map<std::string, double> attributes;  // of the root group, in place of the original's number
  std::vector<AddedVariable> added;
  std::uint64_t locations = 0;  // of which something stays
};

// Whether the edit leaves everything as it is.
bool changes_nothing(const NetcdfFile& file, const NetcdfEdit& edit);

// The new file. The same file and edit give the same bytes, but where a file defines types of its own: HDF5 notes when
// each was made. scratch_path: a name in a folder that can be written to; nothing is left there. slab_bytes: of a
// variable that are in memory at a time, but for one row of its first dimension. Errors: input, where a part of the
// original can't be decoded; temporary, where memory or disk is short; internal.
Result<std::vector<std::uint8_t>> rewrite_netcdf(const NetcdfFile& file, const NetcdfEdit& edit,
                                                 const std::string& scratch_path,
                                                 std::size_t slab_bytes = std::size_t{1} << 28);

}  // namespace thin
