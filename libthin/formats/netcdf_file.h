#pragma once

// Somebody else's netCDF file, of any of netCDF's formats, read from memory: its variables by path, as numbers with NaN
// for missing, whatever they are stored as.
//
// Declared sizes are not believed: a file whose variables could not have come out of so few bytes is refused before
// anything is allocated for them.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libthin/foundation/result.h"

namespace thin {

// More locations, or values of one variable, than any file of soundings has.
constexpr std::size_t kMostLocations = std::size_t{1} << 23;
constexpr std::size_t kMostNetcdfValues = std::size_t{1} << 27;

struct NetcdfVariable {
  int group = 0, id = 0;        // as netCDF numbers them
  std::string path;             // "MetaData/latitude"; "latitude" in the root group
  int type = 0;                 // nc_type
  std::vector<int> dimensions;  // netCDF's numbers of them, which are the file's own
  std::vector<std::size_t> lengths;

  std::size_t count() const;  // of values: 1 for a scalar
};

class NetcdfFile {
 public:
  // bytes must outlive the file; name stands for it in messages. Errors: incomplete, where the end is cut off; input,
  // where it is damaged or declares more than its bytes can hold; temporary, where memory is short.
  static Result<NetcdfFile> open(std::span<const std::uint8_t> bytes, const std::string& name);
  NetcdfFile(NetcdfFile&& other) noexcept;
  NetcdfFile& operator=(NetcdfFile&&) = delete;
  ~NetcdfFile();

  int id() const { return id_; }
  const std::string& name() const { return name_; }
  const std::map<std::string, NetcdfVariable>& variables() const { return variables_; }  // of all groups, by path
  const NetcdfVariable* find(const std::string& path) const;                             // nullptr where there is none

  // The path of a dimension, "Location", and its length; nothing where no dimension of the root group is called so.
  std::optional<std::size_t> dimension_length(const std::string& name) const;
  std::string dimension_name(int dimension) const;

  // Of the root group, or of a variable. Text may be stored as characters or as one string.
  std::optional<std::string> text_attribute(const std::string& name) const;
  std::optional<double> number_attribute(const std::string& name) const;
  std::optional<std::string> text_attribute(const NetcdfVariable& variable, const std::string& name) const;
  std::optional<double> number_attribute(const NetcdfVariable& variable, const std::string& name) const;

  // All values, the last dimension fastest; _FillValue, missing_value and netCDF's own fill values are NaN;
  // scale_factor and add_offset are applied. Errors: input, where it is no number or can't be decoded.
  Result<std::vector<double>> numbers(const NetcdfVariable& variable) const;
  // The same for one entry of the first dimension. REQUIRES: there is such an entry
  Result<std::vector<double>> numbers(const NetcdfVariable& variable, std::size_t row) const;
  // As they are stored: fill values are numbers, nothing is scaled.
  Result<std::vector<double>> stored_numbers(const NetcdfVariable& variable) const;
  // The numbers of a variable over one dimension of this length; none, where there is no such variable.
  Result<std::vector<double>> column(const std::string& path, std::size_t length) const;

  // As texts, without padding: of a string variable one per value, of characters one per row of the last dimension.
  Result<std::vector<std::string>> texts(const NetcdfVariable& variable) const;

  // "FILE: VARIABLE: what netCDF says" as an error of this file.
  Error error(const std::string& where, int netcdf_code) const;

 private:
  NetcdfFile(int id, std::string name) : id_(id), name_(std::move(name)) {}
  Result<std::vector<double>> get(const NetcdfVariable& variable, std::span<const std::size_t> start,
                                  std::span<const std::size_t> count) const;
  void mark_missing(const NetcdfVariable& variable, std::vector<double>& values) const;
  Result<void> list_group(int group, const std::string& path, int depth);
  Result<void> check_sizes(std::size_t file_bytes) const;

  int id_ = -1;
  std::string name_;
  std::map<std::string, NetcdfVariable> variables_;
};

}  // namespace thin
