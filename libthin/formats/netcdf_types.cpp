#include "libthin/formats/netcdf_types.h"

#include <netcdf.h>

#include <cstddef>
#include <vector>

namespace thin {

int NetcdfTypes::of(int type) const {
  const auto found = types_.find(type);
  return found == types_.end() ? type : found->second;
}

int NetcdfTypes::copy_group(int from, int to) {
  int count = 0;
  if (nc_inq_typeids(from, &count, nullptr) != NC_NOERR || count == 0) return NC_NOERR;
  std::vector<int> types(static_cast<std::size_t>(count));
  if (const int code = nc_inq_typeids(from, &count, types.data())) return code;
  for (const int type : types)
    if (const int code = copy_type(from, type, to)) return code;
  return NC_NOERR;
}

int NetcdfTypes::copy_type(int from, int type, int to) {
  char name[NC_MAX_NAME + 1] = {};
  std::size_t size = 0;
  nc_type base = NC_NAT;
  int kind = 0;
  if (const int code = nc_inq_user_type(from, type, name, &size, &base, nullptr, &kind)) return code;
  switch (kind) {
    case NC_ENUM:
      return copy_enumeration(from, type, to);
    case NC_COMPOUND:
      return copy_compound(from, type, to);
    case NC_VLEN:
      return nc_def_vlen(to, name, of(base), &types_[type]);
    case NC_OPAQUE:
      return nc_def_opaque(to, size, name, &types_[type]);
    default:
      return NC_EBADTYPE;
  }
}

int NetcdfTypes::copy_enumeration(int from, int type, int to) {
  char name[NC_MAX_NAME + 1] = {};
  nc_type base = NC_NAT;
  std::size_t members = 0;
  if (const int code = nc_inq_enum(from, type, name, &base, nullptr, &members)) return code;
  if (const int code = nc_def_enum(to, base, name, &types_[type])) return code;
  for (std::size_t i = 0; i < members; ++i) {
    char member[NC_MAX_NAME + 1] = {};
    long long value = 0;
    if (const int code = nc_inq_enum_member(from, type, static_cast<int>(i), member, &value)) return code;
    if (const int code = nc_insert_enum(to, types_[type], member, &value)) return code;
  }
  return NC_NOERR;
}

int NetcdfTypes::copy_compound(int from, int type, int to) {
  char name[NC_MAX_NAME + 1] = {};
  std::size_t size = 0, fields = 0;
  if (const int code = nc_inq_compound(from, type, name, &size, &fields)) return code;
  if (const int code = nc_def_compound(to, size, name, &types_[type])) return code;
  for (std::size_t i = 0; i < fields; ++i) {
    char field[NC_MAX_NAME + 1] = {};
    std::size_t offset = 0;
    nc_type base = NC_NAT;
    int rank = 0, lengths[NC_MAX_VAR_DIMS] = {};
    if (const int code = nc_inq_compound_field(from, type, static_cast<int>(i), field, &offset, &base, &rank, lengths))
      return code;
    const int code = rank == 0 ? nc_insert_compound(to, types_[type], field, offset, of(base))
                               : nc_insert_array_compound(to, types_[type], field, offset, of(base), rank, lengths);
    if (code != NC_NOERR) return code;
  }
  return NC_NOERR;
}

}  // namespace thin
