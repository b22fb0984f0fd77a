#include "libthin/formats/netcdf_image.h"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <cstdlib>

namespace thin {
namespace {

constexpr int kNoDimension = -1;
constexpr std::size_t kFirstImageSize = 1 << 20;
constexpr std::size_t kMostValues = std::size_t{1} << 32;

template <class T>
constexpr nc_type kTypeOf = NC_NAT;
template <>
constexpr nc_type kTypeOf<double> = NC_DOUBLE;
template <>
constexpr nc_type kTypeOf<char> = NC_CHAR;
template <>
constexpr nc_type kTypeOf<std::uint8_t> = NC_UBYTE;
template <>
constexpr nc_type kTypeOf<std::int32_t> = NC_INT;
template <>
constexpr nc_type kTypeOf<std::uint32_t> = NC_UINT;
template <>
constexpr nc_type kTypeOf<std::int64_t> = NC_INT64;
template <>
constexpr nc_type kTypeOf<std::uint64_t> = NC_UINT64;

}  // namespace

NetcdfWriter::NetcdfWriter() {
  check(nc_create_mem("image", NC_NETCDF4, kFirstImageSize, &file_));
  if (failure_ != NC_NOERR) file_ = -1;
}

NetcdfWriter::~NetcdfWriter() {
  if (file_ >= 0) nc_abort(file_);
}

void NetcdfWriter::check(int code) {
  if (failure_ == NC_NOERR) failure_ = code;
}

void NetcdfWriter::put_attribute(const char* name, const std::string& text) {
  if (failure_ == NC_NOERR) check(nc_put_att_text(file_, NC_GLOBAL, name, text.size(), text.data()));
}

void NetcdfWriter::put_attribute(const char* name, int number) {
  if (failure_ == NC_NOERR) check(nc_put_att_int(file_, NC_GLOBAL, name, NC_INT, 1, &number));
}

void NetcdfWriter::put_attribute(const char* name, std::uint32_t number) {
  if (failure_ == NC_NOERR) check(nc_put_att_uint(file_, NC_GLOBAL, name, NC_UINT, 1, &number));
}

int NetcdfWriter::dimension(const char* name, std::size_t length) {
  int id = kNoDimension;
  // netCDF takes length 0 for an unlimited dimension.
  if (failure_ == NC_NOERR && length > 0) check(nc_def_dim(file_, name, length, &id));
  return id;
}

template <class T>
void NetcdfWriter::put(const char* name, std::initializer_list<int> dimensions, std::span<const T> values) {
  if (failure_ != NC_NOERR || values.empty()) return;
  int variable = 0;
  check(nc_def_var(file_, name, kTypeOf<T>, static_cast<int>(dimensions.size()), dimensions.begin(), &variable));
  if (failure_ == NC_NOERR) check(nc_def_var_fill(file_, variable, NC_NOFILL, nullptr));
  if (failure_ == NC_NOERR) check(nc_def_var_deflate(file_, variable, 1, 1, 1));
  if (failure_ == NC_NOERR) check(nc_put_var(file_, variable, values.data()));
}

template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const double>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const char>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const std::uint8_t>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const std::int32_t>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const std::uint32_t>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const std::int64_t>);
template void NetcdfWriter::put(const char*, std::initializer_list<int>, std::span<const std::uint64_t>);

Result<std::vector<std::uint8_t>> NetcdfWriter::finish() {
  NC_memio image = {};
  if (failure_ == NC_NOERR) {
    check(nc_close_memio(file_, &image));
    file_ = -1;
  }
  if (failure_ != NC_NOERR) {
    const ErrorKind kind = failure_ == NC_ENOMEM ? ErrorKind::temporary : ErrorKind::internal;
    return Error{kind, std::string("netCDF: ") + nc_strerror(failure_)};
  }
  const auto* bytes = static_cast<const std::uint8_t*>(image.memory);
  std::vector<std::uint8_t> copy(bytes, bytes + image.size);
  std::free(image.memory);
  return copy;
}

NetcdfReader::NetcdfReader(std::span<const std::uint8_t> bytes) {
  // netCDF never writes to an image opened for reading, but asks for a pointer that could.
  void* memory = const_cast<std::uint8_t*>(bytes.data());
  const int code = bytes.empty() ? NC_ENOTNC : nc_open_mem("image", NC_NOWRITE, bytes.size(), memory, &file_);
  if (code != NC_NOERR) {
    file_ = -1;
    fail(std::string("netCDF: ") + nc_strerror(code));
  }
}

NetcdfReader::~NetcdfReader() {
  if (file_ >= 0) nc_close(file_);
}

void NetcdfReader::fail(const std::string& problem) {
  if (problem_.empty()) problem_ = problem;
}

void NetcdfReader::check(int code, const char* name) {
  if (code != NC_NOERR) fail(std::string(name) + ": " + nc_strerror(code));
}

std::string NetcdfReader::text_attribute(const char* name) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (ok()) check(nc_inq_att(file_, NC_GLOBAL, name, &type, &length), name);
  if (ok() && type != NC_CHAR) fail(std::string(name) + " is no text");
  std::string text(ok() ? length : 0, '\0');
  if (ok()) check(nc_get_att_text(file_, NC_GLOBAL, name, text.data()), name);
  return text;
}

double NetcdfReader::number_attribute(const char* name) {
  std::size_t length = 0;
  nc_type type = NC_NAT;
  if (ok()) check(nc_inq_att(file_, NC_GLOBAL, name, &type, &length), name);
  if (ok() && (length != 1 || (type != NC_INT && type != NC_UINT))) fail(std::string(name) + " is no number");
  double number = 0;
  if (ok()) check(nc_get_att_double(file_, NC_GLOBAL, name, &number), name);
  return number;
}

std::size_t NetcdfReader::length(const char* dimension) {
  int id = 0;
  std::size_t length = 0;
  if (ok() && nc_inq_dimid(file_, dimension, &id) == NC_NOERR) check(nc_inq_dimlen(file_, id, &length), dimension);
  return length;
}

template <class T>
std::vector<T> NetcdfReader::get(const char* name) {
  int variable = 0;
  if (!ok() || nc_inq_varid(file_, name, &variable) != NC_NOERR) return {};
  nc_type type = NC_NAT;
  int rank = 0;
  int dimensions[NC_MAX_VAR_DIMS];
  check(nc_inq_var(file_, variable, nullptr, &type, &rank, dimensions, nullptr), name);
  if (ok() && type != kTypeOf<T>) fail(std::string(name) + " has another type");
  std::size_t count = 1;
  for (int i = 0; i < rank && ok(); ++i) {
    std::size_t length = 0;
    check(nc_inq_dimlen(file_, dimensions[i], &length), name);
    if (length == 0 || count > kMostValues / length) fail(std::string(name) + " has an impossible length");
    count *= length;
  }
  std::vector<T> values(ok() ? count : 0);
  if (ok()) check(nc_get_var(file_, variable, values.data()), name);
  return values;
}

template std::vector<double> NetcdfReader::get(const char*);
template std::vector<char> NetcdfReader::get(const char*);
template std::vector<std::uint8_t> NetcdfReader::get(const char*);
template std::vector<std::int32_t> NetcdfReader::get(const char*);
template std::vector<std::uint32_t> NetcdfReader::get(const char*);
template std::vector<std::int64_t> NetcdfReader::get(const char*);
template std::vector<std::uint64_t> NetcdfReader::get(const char*);

}  // namespace thin
