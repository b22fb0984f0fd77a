#include "libthin/formats/netcdf_rewrite.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_filter.h>
#include <netcdf_mem.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <numeric>

#include "libthin/formats/netcdf_types.h"
#include "libthin/foundation/file_bytes.h"

namespace thin {
namespace {

// Of the image that a classic file grows in. The file is as long as the image and holds what was in its memory before,
// unless it had to grow there: netCDF clears what it adds.
constexpr std::size_t kFirstClassicSize = 1;
constexpr unsigned kFirstOptionalFilter = 4;  // of HDF5's: 1 to 3 are deflate, shuffle and checksum

int creation_mode(int format) {
  switch (format) {
    case NC_FORMAT_NETCDF4:
      return NC_NETCDF4;
    case NC_FORMAT_NETCDF4_CLASSIC:
      return NC_NETCDF4 | NC_CLASSIC_MODEL;
    case NC_FORMAT_64BIT_OFFSET:
      return NC_64BIT_OFFSET;
    case NC_FORMAT_CDF5:
      return NC_64BIT_DATA;
    default:
      return 0;
  }
}

bool is_hdf5(int format) {
  return format == NC_FORMAT_NETCDF4 || format == NC_FORMAT_NETCDF4_CLASSIC;
}

// The entries of one variable that stay, axis by axis; from axis `whole_from` on they all do, in one block.
struct Selection {
  std::vector<std::vector<std::uint32_t>> entries;
  std::vector<std::size_t> strides;  // in bytes
  std::size_t whole_from = 0;
  std::size_t block_bytes = 0;
};

void gather(const Selection& selection, std::size_t axis, const std::byte* from, std::byte*& to) {
  if (axis == selection.whole_from) {
    std::memcpy(to, from, selection.block_bytes);
    to += selection.block_bytes;
    return;
  }
  for (const std::uint32_t entry : selection.entries[axis])
    gather(selection, axis + 1, from + entry * selection.strides[axis], to);
}

class Rewriter {
 public:
  Rewriter(const NetcdfFile& file, const NetcdfEdit& edit, const std::string& scratch_path, std::size_t slab_bytes)
      : file_(file), edit_(edit), scratch_path_(scratch_path), slab_bytes_(slab_bytes) {}
  ~Rewriter() {
    if (output_ >= 0) nc_abort(output_);
  }

  Result<std::vector<std::uint8_t>> run() {
    int format = 0;
    check(nc_inq_format(file_.id(), &format), "its format");
    is_hdf5_ = is_hdf5(format);
    create(creation_mode(format));
    if (!failed_) define_group(file_.id(), output_);
    for (const auto& [name, number] : edit_.attributes) replace_attribute(name, number);
    for (const AddedVariable& variable : edit_.added) define_added(variable);
    if (!failed_) check(nc_enddef(output_), "its definitions");
    for (const auto& [path, variable] : file_.variables()) copy_values(variable);
    for (const AddedVariable& variable : edit_.added) put_added(variable);
    return finish();
  }

 private:
  // Keeps the first failure; after it nothing is done any more.
  void check(int code, const std::string& where) {
    if (failed_ || code == NC_NOERR) return;
    failed_ = true;
    error_ = file_.error(where, code);
  }

  // netCDF-4 made directly in memory lacks the order of creation in its root group, without which netCDF reads types
  // wrongly and won't append. So a file without content is made on disk, and grows in memory from there.
  void create(int mode) {
    if (!is_hdf5_) return check(nc_create_mem("retained", mode, kFirstClassicSize, &output_), "a new image");
    if (Result<void> writable = write_file_bytes(scratch_path_, {}); !writable) return keep(writable.error());
    int blank = -1;
    check(nc_create(scratch_path_.c_str(), mode | NC_CLOBBER, &blank), "a new file");
    if (!failed_) check(nc_close(blank), "a new file");
    Result<std::vector<std::uint8_t>> bytes = read_file_bytes(scratch_path_);
    ::unlink(scratch_path_.c_str());
    if (!bytes) return keep(bytes.error());
    if (failed_) return;
    NC_memio image = {};
    image.size = bytes->size();
    image.memory = std::malloc(bytes->size());  // netCDF's from here on
    if (image.memory == nullptr) return check(NC_ENOMEM, "a new image");
    std::memcpy(image.memory, bytes->data(), bytes->size());
    check(nc_open_memio("retained", NC_WRITE, &image, &output_), "a new image");
    if (failed_) output_ = -1;
    if (!failed_) check(nc_redef(output_), "a new image");
  }

  void keep(const Error& error) {
    if (!failed_) error_ = error;
    failed_ = true;
  }

  void define_group(int from, int to) {
    groups_[from] = to;
    check(types_.copy_group(from, to), "its types");
    define_dimensions(from, to);
    copy_attributes(from, NC_GLOBAL, to, NC_GLOBAL);
    int count = 0;
    if (!failed_) check(nc_inq_nvars(from, &count), "its variables");
    for (int variable = 0; variable < count && !failed_; ++variable) define_variable(from, variable, to);
    int groups = 0;
    if (failed_ || nc_inq_grps(from, &groups, nullptr) != NC_NOERR || groups == 0) return;
    std::vector<int> ids(static_cast<std::size_t>(groups));
    check(nc_inq_grps(from, nullptr, ids.data()), "its groups");
    for (const int id : ids) {
      char name[NC_MAX_NAME + 1] = {};
      int group = 0;
      if (!failed_) check(nc_inq_grpname(id, name), "its groups");
      if (!failed_) check(nc_def_grp(to, name, &group), name);
      if (!failed_) define_group(id, group);
    }
  }

  void define_dimensions(int from, int to) {
    int count = 0, unlimited_count = 0;
    if (!failed_) check(nc_inq_dimids(from, &count, nullptr, 0), "its dimensions");
    if (!failed_) check(nc_inq_unlimdims(from, &unlimited_count, nullptr), "its dimensions");
    if (failed_) return;
    std::vector<int> ids(static_cast<std::size_t>(count)), unlimited(static_cast<std::size_t>(unlimited_count));
    check(nc_inq_dimids(from, &count, ids.data(), 0), "its dimensions");
    check(nc_inq_unlimdims(from, &unlimited_count, unlimited.data()), "its dimensions");
    for (const int id : ids) {
      char name[NC_MAX_NAME + 1] = {};
      std::size_t length = 0;
      if (!failed_) check(nc_inq_dim(from, id, name, &length), "its dimensions");
      if (failed_) return;
      const auto kept = edit_.kept.find(id);
      lengths_[id] = kept == edit_.kept.end() ? length : kept->second.size();
      const bool grows = std::find(unlimited.begin(), unlimited.end(), id) != unlimited.end();
      if (grows) unlimited_.push_back(id);
      check(nc_def_dim(to, name, grows ? NC_UNLIMITED : lengths_[id], &dimensions_[id]), name);
    }
  }

  void copy_attributes(int from, int variable, int to, int new_variable) {
    int count = 0;
    if (!failed_)
      check(variable == NC_GLOBAL ? nc_inq_natts(from, &count) : nc_inq_varnatts(from, variable, &count),
            "its attributes");
    for (int i = 0; i < count && !failed_; ++i) {
      char name[NC_MAX_NAME + 1] = {};
      check(nc_inq_attname(from, variable, i, name), "its attributes");
      if (!failed_) check(nc_copy_att(from, variable, name, to, new_variable), name);
    }
  }

  void define_variable(int from, int id, int to) {
    char name[NC_MAX_NAME + 1] = {};
    nc_type type = NC_NAT;
    int rank = 0, dimensions[NC_MAX_VAR_DIMS], new_id = 0;
    check(nc_inq_var(from, id, name, &type, &rank, dimensions, nullptr), "its variables");
    if (failed_) return;
    const std::vector<int> ids(dimensions, dimensions + rank);
    std::vector<int> new_dimensions;
    for (const int dimension : ids) new_dimensions.push_back(dimensions_.at(dimension));
    check(nc_def_var(to, name, types_.of(type), rank, new_dimensions.data(), &new_id), name);
    variables_[{from, id}] = new_id;
    if (is_hdf5_) copy_storage(from, id, ids, to, new_id, name);
    if (is_hdf5_) copy_fill_mode(from, id, type, to, new_id, name);
    copy_attributes(from, id, to, new_id);
  }

  void copy_storage(int from, int id, const std::vector<int>& dimensions, int to, int new_id, const char* name) {
    int storage = NC_CONTIGUOUS;
    std::vector<std::size_t> chunks(dimensions.size() + 1);
    if (!failed_) check(nc_inq_var_chunking(from, id, &storage, chunks.data()), name);
    for (std::size_t axis = 0; axis < dimensions.size(); ++axis) {
      const bool grows = std::find(unlimited_.begin(), unlimited_.end(), dimensions[axis]) != unlimited_.end();
      if (!grows) chunks[axis] = std::min(chunks[axis], lengths_.at(dimensions[axis]));
    }
    if (!failed_ && !dimensions.empty()) check(nc_def_var_chunking(to, new_id, storage, chunks.data()), name);
    int endian = NC_ENDIAN_NATIVE;
    nc_type type = NC_NAT;
    if (!failed_) check(nc_inq_vartype(from, id, &type), name);
    // Texts and other values of variable size lie outside of the chunks: netCDF allows no filters on them.
    if (storage == NC_CHUNKED && type < NC_STRING) copy_filters(from, id, to, new_id, name);
    const bool has_order = type >= NC_SHORT && type <= NC_UINT64 && type != NC_UBYTE;
    if (!failed_ && has_order) check(nc_inq_var_endian(from, id, &endian), name);
    if (!failed_ && has_order && endian != NC_ENDIAN_NATIVE) check(nc_def_var_endian(to, new_id, endian), name);
  }

  void copy_filters(int from, int id, int to, int new_id, const char* name) {
    int shuffle = 0, deflate = 0, level = 0, checksum = 0;
    if (!failed_) check(nc_inq_var_deflate(from, id, &shuffle, &deflate, &level), name);
    if (!failed_ && (shuffle || deflate)) check(nc_def_var_deflate(to, new_id, shuffle, deflate, level), name);
    if (!failed_) check(nc_inq_var_fletcher32(from, id, &checksum), name);
    if (!failed_ && checksum) check(nc_def_var_fletcher32(to, new_id, checksum), name);
    std::size_t count = 0;
    if (failed_ || nc_inq_var_filter_ids(from, id, &count, nullptr) != NC_NOERR || count == 0) return;
    std::vector<unsigned> filters(count);
    check(nc_inq_var_filter_ids(from, id, &count, filters.data()), name);
    for (const unsigned filter : filters) {
      if (failed_ || filter < kFirstOptionalFilter) continue;
      std::size_t length = 0;
      check(nc_inq_var_filter_info(from, id, filter, &length, nullptr), name);
      std::vector<unsigned> parameters(length + 1);
      if (!failed_) check(nc_inq_var_filter_info(from, id, filter, &length, parameters.data()), name);
      if (!failed_) check(nc_def_var_filter(to, new_id, filter, length, parameters.data()), name);
    }
  }

  // A fill value of its own comes with the attributes.
  void copy_fill_mode(int from, int id, nc_type type, int to, int new_id, const char* name) {
    int no_fill = 0;
    if (!failed_ && type != NC_STRING && type < NC_FIRSTUSERTYPEID)
      check(nc_inq_var_fill(from, id, &no_fill, nullptr), name);
    if (!failed_) check(nc_def_var_fill(to, new_id, no_fill ? NC_NOFILL : NC_FILL, nullptr), name);
  }

  void replace_attribute(const std::string& name, double number) {
    nc_type type = NC_NAT;
    if (!failed_) check(nc_inq_atttype(file_.id(), NC_GLOBAL, name.c_str(), &type), name);
    if (!failed_) check(nc_put_att_double(output_, NC_GLOBAL, name.c_str(), type, 1, &number), name);
  }

  void define_added(const AddedVariable& added) {
    const NetcdfVariable& like = *file_.find(added.like);
    int group = output_, id = 0;
    std::string name = added.path;
    const std::size_t slash = name.find('/');
    if (slash != std::string::npos) {
      const std::string group_name = name.substr(0, slash);
      name.erase(0, slash + 1);
      if (nc_inq_grp_ncid(output_, group_name.c_str(), &group) != NC_NOERR && !failed_)
        check(nc_def_grp(output_, group_name.c_str(), &group), group_name);
    }
    std::vector<int> dimensions;
    for (const int dimension : like.dimensions) dimensions.push_back(dimensions_.at(dimension));
    if (!failed_)
      check(nc_def_var(group, name.c_str(), NC_INT, static_cast<int>(dimensions.size()), dimensions.data(), &id), name);
    if (is_hdf5_ && !failed_) copy_storage(like.group, like.id, like.dimensions, group, id, name.c_str());
    const int fill = NC_FILL_INT;
    if (!failed_) check(nc_put_att_int(group, id, "_FillValue", NC_INT, 1, &fill), name);
    if (!failed_ && !added.flag_values.empty())
      check(nc_put_att_int(group, id, "flag_values", NC_INT, added.flag_values.size(), added.flag_values.data()), name);
    for (const auto& [attribute, text] : added.attributes)
      if (!failed_) check(nc_put_att_text(group, id, attribute.c_str(), text.size(), text.data()), name);
    added_ids_.emplace_back(group, id);
  }

  void put_added(const AddedVariable& added) {
    const auto& [group, id] = added_ids_[static_cast<std::size_t>(&added - edit_.added.data())];
    const NetcdfVariable& like = *file_.find(added.like);
    std::vector<std::size_t> start(like.dimensions.size(), 0), count;
    for (const int dimension : like.dimensions) count.push_back(lengths_.at(dimension));
    if (!failed_) check(nc_put_vara_int(group, id, start.data(), count.data(), added.values.data()), added.path);
  }

  Selection selection_of(const NetcdfVariable& variable, std::size_t value_bytes) const {
    Selection selection;
    const std::size_t rank = variable.lengths.size();
    selection.strides.assign(rank, value_bytes);
    for (std::size_t axis = rank; axis-- > 1;)
      selection.strides[axis - 1] = selection.strides[axis] * variable.lengths[axis];
    for (std::size_t axis = 0; axis < rank; ++axis) {
      const auto kept = edit_.kept.find(variable.dimensions[axis]);
      std::vector<std::uint32_t>& entries = selection.entries.emplace_back();
      if (kept != edit_.kept.end()) {
        entries = kept->second;
        selection.whole_from = axis + 1;
      }
    }
    for (std::size_t axis = 0; axis < selection.whole_from; ++axis) {
      if (!selection.entries[axis].empty() || lengths_.at(variable.dimensions[axis]) == 0) continue;
      selection.entries[axis].resize(variable.lengths[axis]);
      std::iota(selection.entries[axis].begin(), selection.entries[axis].end(), 0U);
    }
    selection.block_bytes = value_bytes;
    for (std::size_t axis = selection.whole_from; axis < rank; ++axis) selection.block_bytes *= variable.lengths[axis];
    return selection;
  }

  // Where a variable's values go: group and number in the new file, and its new shape.
  struct Target {
    int group = 0, id = 0;
    std::vector<std::size_t> start, count;
  };

  void copy_values(const NetcdfVariable& variable) {
    if (failed_ || variable.count() == 0) return;
    Target target{groups_.at(variable.group), variables_.at({variable.group, variable.id}), {}, {}};
    for (const int dimension : variable.dimensions) target.count.push_back(lengths_.at(dimension));
    target.start.assign(target.count.size(), 0);
    const auto replacement = edit_.replaced.find(variable.path);
    if (replacement != edit_.replaced.end())
      put_replaced(variable.path, target, replacement->second);
    else
      copy_slabs(variable, target);
  }

  void put_replaced(const std::string& path, const Target& target, const std::vector<double>& values) {
    std::size_t wanted = 1;
    for (const std::size_t length : target.count) wanted *= length;
    if (values.size() != wanted) return check(NC_EEDGE, path);
    check(nc_put_vara_double(target.group, target.id, target.start.data(), target.count.data(), values.data()), path);
  }

  // Slabs along the first axis; one for all but the largest variables, so that no chunk is packed twice.
  void copy_slabs(const NetcdfVariable& variable, Target& target) {
    std::size_t value_bytes = 0;
    check(nc_inq_type(variable.group, variable.type, nullptr, &value_bytes), variable.path);
    if (failed_ || value_bytes == 0) return;
    const bool scalar = variable.lengths.empty();
    const std::size_t rows = scalar ? 1 : variable.lengths[0], row_bytes = variable.count() / rows * value_bytes;
    const std::size_t slab_rows = std::max<std::size_t>(1, std::min(rows, slab_bytes_ / row_bytes));
    const Selection selection = selection_of(variable, value_bytes);
    std::vector<std::size_t> start(variable.lengths.size(), 0), count = variable.lengths;
    std::vector<std::byte> slab(slab_rows * row_bytes), retained(slab.size());
    for (std::size_t begin = 0; begin < rows && !failed_; begin += slab_rows) {
      const std::size_t taken = std::min(slab_rows, rows - begin);
      if (!scalar) start[0] = begin, count[0] = taken;
      check(nc_get_vara(variable.group, variable.id, start.data(), count.data(), slab.data()), variable.path);
      if (failed_) return;
      const Selection in_slab = rows_of(selection, begin, taken, row_bytes);
      std::byte* end = retained.data();
      gather(in_slab, 0, slab.data(), end);
      if (!scalar) target.count[0] = in_slab.whole_from > 0 ? in_slab.entries[0].size() : taken;
      if (end != retained.data())
        check(nc_put_vara(target.group, target.id, target.start.data(), target.count.data(), retained.data()),
              variable.path);
      if (!scalar) target.start[0] += target.count[0];
      // Texts and lists of the slab lie elsewhere; the retained ones were the same.
      if (variable.type >= NC_STRING)
        check(nc_reclaim_data(variable.group, variable.type, slab.data(), taken * row_bytes / value_bytes),
              variable.path);
    }
  }

  // The part of a selection that lies in these rows of the first axis, counted from the first of them.
  static Selection rows_of(const Selection& selection, std::size_t begin, std::size_t taken, std::size_t row_bytes) {
    Selection part = selection;
    if (selection.whole_from == 0) {
      part.block_bytes = taken * row_bytes;
      return part;
    }
    const std::vector<std::uint32_t>& all = selection.entries[0];
    const auto first = std::lower_bound(all.begin(), all.end(), begin);
    const auto last = std::lower_bound(first, all.end(), begin + taken);
    part.entries[0].clear();
    for (auto entry = first; entry != last; ++entry)
      part.entries[0].push_back(static_cast<std::uint32_t>(*entry - begin));
    return part;
  }

  Result<std::vector<std::uint8_t>> finish() {
    NC_memio image = {};
    if (!failed_) {
      check(nc_close_memio(output_, &image), "the new image");
      output_ = -1;
    }
    if (failed_) return error_;
    const auto* bytes = static_cast<const std::uint8_t*>(image.memory);
    std::vector<std::uint8_t> copy(bytes, bytes + image.size);
    std::free(image.memory);
    return copy;
  }

  const NetcdfFile& file_;
  const NetcdfEdit& edit_;
  const std::string& scratch_path_;
  std::size_t slab_bytes_;
  int output_ = -1;
  bool is_hdf5_ = false;
  bool failed_ = false;
  Error error_;
  NetcdfTypes types_;
  std::map<int, int> groups_, dimensions_;        // the original's number: the new one's
  std::map<std::pair<int, int>, int> variables_;  // group and variable of the original: the new one's
  std::map<int, std::size_t> lengths_;            // new length, by the original's number of the dimension
  std::vector<int> unlimited_;
  std::vector<std::pair<int, int>> added_ids_;
};

}  // namespace

bool changes_nothing(const NetcdfFile& file, const NetcdfEdit& edit) {
  if (!edit.replaced.empty() || !edit.attributes.empty() || !edit.added.empty()) return false;
  return std::all_of(edit.kept.begin(), edit.kept.end(), [&](const auto& kept) {
    std::size_t length = 0;
    return nc_inq_dimlen(file.id(), kept.first, &length) == NC_NOERR && length == kept.second.size();
  });
}

Result<std::vector<std::uint8_t>> rewrite_netcdf(const NetcdfFile& file, const NetcdfEdit& edit,
                                                 const std::string& scratch_path, std::size_t slab_bytes) {
  return Rewriter(file, edit, scratch_path, slab_bytes).run();
}

}  // namespace thin
