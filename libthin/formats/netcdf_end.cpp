#include "libthin/formats/netcdf_end.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace thin {
namespace {

constexpr std::string_view kHdf5Signature("\x89HDF\r\n\x1a\n", 8);
constexpr std::size_t kLongestSuperblock = 96;
constexpr std::uint64_t kLongestList = 65536;  // of dimensions, variables or attributes: no file of soundings has more

// Little-endian, as all of HDF5's own numbers are. REQUIRES: they are there
std::uint64_t little_endian(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | bytes[offset + i];
  return value;
}

// The end that the superblock states (HDF5 file format specification, II.A); nothing where it makes no sense.
std::optional<std::uint64_t> hdf5_end(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kLongestSuperblock) return kLongestSuperblock;
  const int version = bytes[8];
  if (version > 3) return std::nullopt;
  const std::size_t offset_size = bytes[version < 2 ? 13 : 9];
  if (offset_size != 4 && offset_size != 8) return std::nullopt;
  // Base address, one other address, end of file.
  const std::size_t addresses = version == 0 ? 24 : version == 1 ? 28 : 12;
  return little_endian(bytes, addresses + 2 * offset_size, offset_size);
}

// The header of a classic file (NetCDF User's Guide, appendix B: header = magic numrecs dim_list gatt_list var_list).
// Keeps in mind whether the bytes ran out, or made no sense.
class ClassicHeader {
 public:
  explicit ClassicHeader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Where the last variable ends, or more than the file has where the header itself is cut; nothing where it makes no
  // sense: netCDF 4.9.0 falls over some of these (lists of millions, records in the midst of a variable).
  std::optional<std::uint64_t> end() {
    take(3);
    const std::uint64_t version = number(1);
    count_size_ = version == 5 ? 8 : 4;
    offset_size_ = version == 1 ? 4 : 8;
    records_ = number(count_size_);
    if (records_ == kStreaming || records_ > std::uint64_t{1} << 40) records_ = 0;
    read_dimensions();
    skip_attributes();
    read_variables();
    if (is_cut_) return bytes_.size() + 1;
    if (is_senseless_) return std::nullopt;
    return last_end();
  }

 private:
  static constexpr std::uint64_t kStreaming = 0xffffffff, kLongestName = 4096;
  static constexpr std::uint64_t kDimensions = 10, kVariables = 11, kAttributes = 12;

  struct Variable {
    std::uint64_t begin = 0, size = 0;  // of one record, where it has records
    bool has_records = false;
  };

  bool good() const { return !is_cut_ && !is_senseless_; }

  void take(std::uint64_t count) {
    if (!good()) return;
    if (count > bytes_.size() - place_)
      is_cut_ = true;
    else
      place_ += count;
  }

  std::uint64_t number(std::size_t size) {
    take(size);
    if (!good()) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = place_ - size; i < place_; ++i) value = value << 8 | bytes_[i];
    return value;
  }

  static std::uint64_t padded(std::uint64_t size) { return (size + 3) / 4 * 4; }

  // Of a list: its tag is the one expected, or the list is absent.
  std::uint64_t list_length(std::uint64_t wanted) {
    const std::uint64_t tag = number(4), length = number(count_size_);
    if (good() && tag != wanted && (tag != 0 || length != 0)) is_senseless_ = true;
    if (length > kLongestList) is_senseless_ = true;
    return good() ? length : 0;
  }

  void skip_name() {
    const std::uint64_t length = number(count_size_);
    if (good() && (length == 0 || length > kLongestName)) is_senseless_ = true;
    take(padded(length));
  }

  static std::uint64_t size_of(std::uint64_t type) {
    constexpr std::uint64_t kSizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < std::size(kSizes) ? kSizes[type] : 0;
  }

  void read_dimensions() {
    const std::uint64_t count = list_length(kDimensions);
    for (std::uint64_t i = 0; i < count && good(); ++i) {
      skip_name();
      lengths_.push_back(number(count_size_));
    }
  }

  void skip_attributes() {
    const std::uint64_t count = list_length(kAttributes);
    for (std::uint64_t i = 0; i < count && good(); ++i) {
      skip_name();
      const std::uint64_t size = size_of(number(4)), length = number(count_size_);
      if (size == 0 || length > bytes_.size()) is_senseless_ = true;
      if (good()) take(padded(size * length));
    }
  }

  void read_variables() {
    const std::uint64_t count = list_length(kVariables);
    for (std::uint64_t i = 0; i < count && good(); ++i) {
      skip_name();
      Variable variable;
      std::uint64_t values = 1;
      const std::uint64_t rank = number(count_size_);
      if (rank > 1024) is_senseless_ = true;
      for (std::uint64_t axis = 0; axis < rank && good(); ++axis) {
        const std::uint64_t dimension = number(count_size_);
        if (!good()) break;
        if (dimension >= lengths_.size()) is_senseless_ = true;
        const std::uint64_t length = is_senseless_ ? 1 : lengths_[dimension];
        // The dimension of the records has length 0, and is the first of a variable or none.
        if (axis == 0 && length == 0)
          variable.has_records = true;
        else if (length == 0 || __builtin_mul_overflow(values, length, &values))
          is_senseless_ = true;
      }
      skip_attributes();
      const std::uint64_t type_size = size_of(number(4));
      number(count_size_);  // vsize, which says the same, but for large variables nothing
      variable.begin = number(offset_size_);
      if (good() && (type_size == 0 || __builtin_mul_overflow(values, type_size, &variable.size))) is_senseless_ = true;
      variables_.push_back(variable);
    }
  }

  std::optional<std::uint64_t> last_end() const {
    const auto has_records = [](const Variable& variable) { return variable.has_records; };
    const auto record_variables = std::count_if(variables_.begin(), variables_.end(), has_records);
    std::uint64_t record_size = 0, end = place_;
    for (const Variable& variable : variables_)
      if (variable.has_records) record_size += record_variables == 1 ? variable.size : padded(variable.size);
    for (const Variable& variable : variables_) {
      std::uint64_t begin = variable.begin, records_before = 0;
      if (variable.has_records && records_ == 0) continue;
      if (variable.has_records && __builtin_mul_overflow(records_ - 1, record_size, &records_before))
        return std::nullopt;
      if (__builtin_add_overflow(begin, records_before, &begin)) return std::nullopt;
      if (__builtin_add_overflow(begin, variable.size, &begin)) return std::nullopt;
      end = std::max(end, begin);
    }
    return end;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t place_ = 0;
  std::size_t count_size_ = 4, offset_size_ = 4;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> lengths_;
  std::vector<Variable> variables_;
  bool is_cut_ = false, is_senseless_ = false;
};

}  // namespace

Result<void> check_netcdf_end(std::span<const std::uint8_t> bytes, const std::string& name) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const bool is_hdf5 = text.starts_with(kHdf5Signature);
  const std::optional<std::uint64_t> end = is_hdf5 ? hdf5_end(bytes) : ClassicHeader(bytes).end();
  if (!end && !is_hdf5)
    return Error{ErrorKind::input, name +
                                       ": the header of this netCDF file makes no sense: it is damaged. Ask the "
                                       "sender for it again."};
  if (!end || *end <= bytes.size()) return {};
  return Error{ErrorKind::incomplete, name + ": the file is cut: it has " + std::to_string(bytes.size()) +
                                          " bytes of at least " + std::to_string(*end) +
                                          ". Wait for the rest, or ask the sender for it again."};
}

}  // namespace thin
