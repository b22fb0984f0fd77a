#include "libthin/formats/netcdf_file.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libthin/formats/netcdf_end.h"

namespace thin {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr int kDeepestGroup = 16;
constexpr std::size_t kMostVariables = 10000;
constexpr std::size_t kLongestText = 1 << 16;

// No filter of HDF5's makes more of a byte than deflate, 1032; what a small file may declare beyond, in padding and
// variables that were never written.
constexpr std::size_t kBytesPerStoredByte = 1100;
constexpr std::size_t kBytesGranted = std::size_t{64} << 20;

std::string joined(const std::string& group, const std::string& name) {
  return group.empty() ? name : group + "/" + name;
}

// What netCDF fills unwritten values of a type with. Bytes have none: all of their values are meant.
double default_fill(int type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return static_cast<double>(NC_FILL_INT64);
    case NC_UINT64:
      return static_cast<double>(NC_FILL_UINT64);
    case NC_FLOAT:
      return static_cast<double>(NC_FILL_FLOAT);
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return kMissing;
  }
}

bool is_number(int type) {
  return type >= NC_BYTE && type <= NC_UINT64 && type != NC_CHAR;
}

std::string trimmed(std::string text) {
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  while (!text.empty() && text.back() == ' ') text.pop_back();
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

std::optional<std::string> text_of_attribute(int group, int variable, const std::string& name) {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(group, variable, name.c_str(), &type, &length) != NC_NOERR || length > kLongestText)
    return std::nullopt;
  if (type == NC_CHAR) {
    std::string text(length, '\0');
    if (length > 0 && nc_get_att_text(group, variable, name.c_str(), text.data()) != NC_NOERR) return std::nullopt;
    return trimmed(text);
  }
  if (type != NC_STRING || length != 1) return std::nullopt;
  char* stored = nullptr;
  if (nc_get_att_string(group, variable, name.c_str(), &stored) != NC_NOERR) return std::nullopt;
  const std::string text = stored ? stored : "";
  nc_free_string(1, &stored);
  return trimmed(text);
}

std::optional<double> number_of_attribute(int group, int variable, const std::string& name) {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  double number = 0;
  if (nc_inq_att(group, variable, name.c_str(), &type, &length) != NC_NOERR) return std::nullopt;
  if (!is_number(type) || length != 1) return std::nullopt;
  if (nc_get_att_double(group, variable, name.c_str(), &number) != NC_NOERR) return std::nullopt;
  return number;
}

}  // namespace

std::size_t NetcdfVariable::count() const {
  std::size_t count = 1;
  for (const std::size_t length : lengths)
    if (__builtin_mul_overflow(count, length, &count)) return std::numeric_limits<std::size_t>::max();
  return count;
}

NetcdfFile::NetcdfFile(NetcdfFile&& other) noexcept
    : id_(std::exchange(other.id_, -1)), name_(std::move(other.name_)), variables_(std::move(other.variables_)) {}

NetcdfFile::~NetcdfFile() {
  if (id_ >= 0) nc_close(id_);
}

Result<NetcdfFile> NetcdfFile::open(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (const Result<void> whole = check_netcdf_end(bytes, name); !whole) return whole.error();
  // netCDF never writes to an image opened for reading, but asks for a pointer that could.
  void* memory = const_cast<std::uint8_t*>(bytes.data());
  int id = -1;
  const int code = nc_open_mem("observations", NC_NOWRITE, bytes.size(), memory, &id);
  if (code == NC_ENOMEM) return Error{ErrorKind::temporary, name + ": not enough memory to open it"};
  if (code != NC_NOERR)
    return Error{ErrorKind::input, fmt::format("{}: netCDF can't open it ({}): it is damaged, or HDF5 of a kind that "
                                               "netCDF does not read. Ask the sender for it again, as netCDF-4.",
                                               name, nc_strerror(code))};
  NetcdfFile file(id, name);
  if (const Result<void> listed = file.list_group(id, "", 0); !listed) return listed.error();
  if (const Result<void> fits = file.check_sizes(bytes.size()); !fits) return fits.error();
  return file;
}

Result<void> NetcdfFile::list_group(int group, const std::string& path, int depth) {
  int count = 0;
  if (const int code = nc_inq_nvars(group, &count); code != NC_NOERR) return error(path, code);
  for (int id = 0; id < count; ++id) {
    char name[NC_MAX_NAME + 1] = {};
    int rank = 0, dimensions[NC_MAX_VAR_DIMS];
    NetcdfVariable variable{group, id, "", NC_NAT, {}, {}};
    const int code = nc_inq_var(group, id, name, &variable.type, &rank, dimensions, nullptr);
    if (code != NC_NOERR) return error(path, code);
    variable.path = joined(path, name);
    variable.dimensions.assign(dimensions, dimensions + rank);
    for (const int dimension : variable.dimensions) {
      std::size_t length = 0;
      if (const int failed = nc_inq_dimlen(group, dimension, &length)) return error(variable.path, failed);
      variable.lengths.push_back(length);
    }
    variables_.emplace(variable.path, variable);
    if (variables_.size() > kMostVariables)
      return Error{ErrorKind::input, fmt::format("{}: it declares more than {} variables, which no file of soundings "
                                                 "has. Send one file per instrument.",
                                                 name_, kMostVariables)};
  }
  int groups = 0;
  if (nc_inq_grps(group, &groups, nullptr) != NC_NOERR || groups == 0) return {};
  std::vector<int> ids(static_cast<std::size_t>(groups));
  if (const int code = nc_inq_grps(group, nullptr, ids.data()); code != NC_NOERR) return error(path, code);
  if (depth == kDeepestGroup)
    return Error{ErrorKind::input,
                 name_ + ": its groups are nested without end. Send it in a layout of docs/formats.md."};
  for (const int id : ids) {
    char name[NC_MAX_NAME + 1] = {};
    if (const int code = nc_inq_grpname(id, name); code != NC_NOERR) return error(path, code);
    if (Result<void> listed = list_group(id, joined(path, name), depth + 1); !listed) return listed;
  }
  return {};
}

Result<void> NetcdfFile::check_sizes(std::size_t file_bytes) const {
  const std::size_t most = kBytesPerStoredByte * std::min(file_bytes, std::size_t{1} << 40) + kBytesGranted;
  std::size_t declared = 0;
  for (const auto& [path, variable] : variables_) {
    std::size_t size = 1, total = 0;
    nc_inq_type(variable.group, variable.type, nullptr, &size);
    if (!__builtin_mul_overflow(variable.count(), std::max<std::size_t>(size, 1), &total) &&
        !__builtin_add_overflow(declared, total, &declared) && declared <= most)
      continue;
    return Error{ErrorKind::input,
                 fmt::format("{}: {} is declared with {} values, more than {} bytes can hold: it is damaged. Ask the "
                             "sender for it again.",
                             name_, path, fmt::join(variable.lengths, " x "), file_bytes)};
  }
  return {};
}

const NetcdfVariable* NetcdfFile::find(const std::string& path) const {
  const auto found = variables_.find(path);
  return found == variables_.end() ? nullptr : &found->second;
}

std::optional<std::size_t> NetcdfFile::dimension_length(const std::string& name) const {
  int dimension = 0;
  std::size_t length = 0;
  if (nc_inq_dimid(id_, name.c_str(), &dimension) != NC_NOERR) return std::nullopt;
  if (nc_inq_dimlen(id_, dimension, &length) != NC_NOERR) return std::nullopt;
  return length;
}

std::string NetcdfFile::dimension_name(int dimension) const {
  char name[NC_MAX_NAME + 1] = {};
  return nc_inq_dimname(id_, dimension, name) == NC_NOERR ? name : "";
}

std::optional<std::string> NetcdfFile::text_attribute(const std::string& name) const {
  return text_of_attribute(id_, NC_GLOBAL, name);
}

std::optional<double> NetcdfFile::number_attribute(const std::string& name) const {
  return number_of_attribute(id_, NC_GLOBAL, name);
}

std::optional<std::string> NetcdfFile::text_attribute(const NetcdfVariable& variable, const std::string& name) const {
  return text_of_attribute(variable.group, variable.id, name);
}

std::optional<double> NetcdfFile::number_attribute(const NetcdfVariable& variable, const std::string& name) const {
  return number_of_attribute(variable.group, variable.id, name);
}

Error NetcdfFile::error(const std::string& where, int netcdf_code) const {
  const ErrorKind kind = netcdf_code == NC_ENOMEM ? ErrorKind::temporary : ErrorKind::input;
  return {kind,
          fmt::format("{}: {}: netCDF says \"{}\". It is damaged, or uses a filter that is not installed: ask the "
                      "sender for it again, deflated or plain.",
                      name_, where.empty() ? "its header" : where, nc_strerror(netcdf_code))};
}

Result<std::vector<double>> NetcdfFile::get(const NetcdfVariable& variable, std::span<const std::size_t> start,
                                            std::span<const std::size_t> count) const {
  if (!is_number(variable.type) || variable.count() > kMostNetcdfValues)
    return Error{ErrorKind::input,
                 fmt::format("{}: {} holds no numbers, or more than {} of them. Send it as the layout has it "
                             "(docs/formats.md).",
                             name_, variable.path, kMostNetcdfValues)};
  std::size_t length = 1;
  for (const std::size_t entries : count) length *= entries;
  std::vector<double> values(length);
  if (values.empty()) return values;
  const int code = nc_get_vara_double(variable.group, variable.id, start.data(), count.data(), values.data());
  if (code != NC_NOERR) return error(variable.path, code);
  return values;
}

void NetcdfFile::mark_missing(const NetcdfVariable& variable, std::vector<double>& values) const {
  const double fill = number_attribute(variable, "_FillValue").value_or(default_fill(variable.type));
  const double missing = number_attribute(variable, "missing_value").value_or(fill);
  const double scale = number_attribute(variable, "scale_factor").value_or(1);
  const double offset = number_attribute(variable, "add_offset").value_or(0);
  for (double& value : values) {
    if (value == fill || value == missing || !std::isfinite(value))
      value = kMissing;
    else if (scale != 1 || offset != 0)
      value = value * scale + offset;
  }
}

Result<std::vector<double>> NetcdfFile::stored_numbers(const NetcdfVariable& variable) const {
  const std::vector<std::size_t> start(variable.lengths.size(), 0);
  return get(variable, start, variable.lengths);
}

Result<std::vector<double>> NetcdfFile::numbers(const NetcdfVariable& variable) const {
  Result<std::vector<double>> values = stored_numbers(variable);
  if (values) mark_missing(variable, *values);
  return values;
}

Result<std::vector<double>> NetcdfFile::numbers(const NetcdfVariable& variable, std::size_t row) const {
  std::vector<std::size_t> start(variable.lengths.size(), 0), count = variable.lengths;
  start[0] = row;
  count[0] = 1;
  Result<std::vector<double>> values = get(variable, start, count);
  if (values) mark_missing(variable, *values);
  return values;
}

Result<std::vector<double>> NetcdfFile::column(const std::string& path, std::size_t length) const {
  const NetcdfVariable* variable = find(path);
  if (!variable || variable->lengths != std::vector<std::size_t>{length}) return std::vector<double>();
  return numbers(*variable);
}

Result<std::vector<std::string>> NetcdfFile::texts(const NetcdfVariable& variable) const {
  const bool characters = variable.type == NC_CHAR && !variable.lengths.empty();
  if ((!characters && variable.type != NC_STRING) || variable.count() > kMostNetcdfValues)
    return Error{ErrorKind::input,
                 name_ + ": " + variable.path + " holds no texts. Send it as the layout has it (docs/formats.md)."};
  std::vector<std::string> texts;
  if (variable.count() == 0) return texts;
  if (characters) {
    std::vector<char> values(variable.count());
    if (const int code = nc_get_var_text(variable.group, variable.id, values.data()); code != NC_NOERR)
      return error(variable.path, code);
    const std::size_t width = variable.lengths.back();
    for (auto row = values.begin(); row != values.end(); row += static_cast<std::ptrdiff_t>(width))
      texts.push_back(trimmed(std::string(row, row + static_cast<std::ptrdiff_t>(width))));
    return texts;
  }
  std::vector<char*> values(variable.count(), nullptr);
  if (const int code = nc_get_var_string(variable.group, variable.id, values.data()); code != NC_NOERR)
    return error(variable.path, code);
  for (const char* value : values) texts.push_back(trimmed(value ? value : ""));
  nc_free_string(values.size(), values.data());
  return texts;
}

}  // namespace thin
