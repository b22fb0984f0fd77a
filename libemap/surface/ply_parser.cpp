// PLY, the body: elements row by row, in any of the three encodings.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "libemap/surface/model_parsers.h"
#include "libemap/surface/ply_header.h"
#include "libemap/surface/text_scanner.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

static_assert(std::endian::native == std::endian::little, "values are loaded as they lie");

template <class Value>
double load(const std::uint8_t* place, bool swapped) {
  std::array<std::uint8_t, sizeof(Value)> bytes;
  std::memcpy(bytes.data(), place, sizeof(Value));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<Value>(bytes));
}

double load(PlyType type, const std::uint8_t* place, bool swapped) {
  switch (type) {
    case PlyType::int8:
      return load<std::int8_t>(place, swapped);
    case PlyType::uint8:
      return load<std::uint8_t>(place, swapped);
    case PlyType::int16:
      return load<std::int16_t>(place, swapped);
    case PlyType::uint16:
      return load<std::uint16_t>(place, swapped);
    case PlyType::int32:
      return load<std::int32_t>(place, swapped);
    case PlyType::uint32:
      return load<std::uint32_t>(place, swapped);
    case PlyType::float32:
      return load<float>(place, swapped);
    case PlyType::float64:
      return load<double>(place, swapped);
  }
  return 0;
}

// The values of the elements in the order of the file, however they are written.
class PlyValues {
 public:
  PlyValues(Bytes body, const PlyHeader& header)
      : binary_(header.encoding != PlyEncoding::ascii),
        swapped_(header.encoding == PlyEncoding::big_endian),
        rest_(body),
        text_(body) {}

  // The next value; nothing where the file ends, or where the text is no number.
  std::optional<double> next(PlyType type) {
    if (!binary_) return next_word();
    const std::size_t size = size_of(type);
    if (rest_.size() < size) return std::nullopt;
    const double value = load(type, rest_.data(), swapped_);
    rest_ = rest_.subspan(size);
    return value;
  }

  std::size_t bytes_left() const { return binary_ ? rest_.size() : line_.size() + text_.bytes_left(); }

  Error error(const std::string& where) const {
    const std::string_view word = TextScanner::trimmed(line_);
    if (!word.empty())
      return {ErrorKind::input, fmt::format("{} has \"{}\" where a number belongs", where, word.substr(0, 20))};
    return {ErrorKind::incomplete, fmt::format("it ends within {}: the file is cut off", where)};
  }

 private:
  std::optional<double> next_word() {
    line_ = TextScanner::trimmed(line_);
    while (line_.empty()) {
      const std::optional<std::string_view> line = text_.next_line();
      if (!line) return std::nullopt;
      line_ = *line;
    }
    return TextScanner::take_number<double>(line_);
  }

  bool binary_, swapped_;
  Bytes rest_;
  TextScanner text_;
  std::string_view line_;
};

// Rows that the header promises and the file can't hold are found out before memory is asked for.
Result<void> check_size(const PlyElement& element, const PlyValues& values) {
  std::size_t row = 0;
  for (const PlyProperty& property : element.properties) row += property.least_size();
  // In text a value takes a digit and a blank at least.
  const std::size_t least = std::max<std::size_t>(1, std::min(row, 2 * element.properties.size()));
  if (element.count > values.bytes_left() / least + 1)
    return Error{ErrorKind::incomplete,
                 fmt::format("its header promises {} of element {}, the file holds at most {}: it "
                             "is cut off",
                             element.count, element.name, values.bytes_left() / least)};
  return {};
}

// Reads one row: scalars to `scalars`, one for each property; the list of that name to `list`.
bool read_row(const PlyElement& element, PlyValues& values, std::vector<double>& scalars,
              std::vector<std::int64_t>& list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::optional<double> value = values.next(property.count_type.value_or(property.type));
    if (!value) return false;
    if (!property.count_type) {
      scalars[i] = *value;
      continue;
    }
    if (!(*value >= 0) || *value > static_cast<double>(values.bytes_left())) return false;
    const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
    if (wanted) list.clear();
    for (auto count = static_cast<std::size_t>(*value); count-- > 0;) {
      const std::optional<double> entry = values.next(property.type);
      if (!entry) return false;
      // Out of range on purpose where it is no index at all: the error then names the face.
      if (wanted) list.push_back(std::abs(*entry) < 1e15 ? static_cast<std::int64_t>(*entry) : -1);
    }
  }
  return true;
}

std::optional<std::size_t> property_index(const PlyElement& element, const char* name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name && !element.properties[i].count_type) return i;
  return std::nullopt;
}

using Columns = std::optional<std::array<std::size_t, 3>>;

Columns columns(const PlyElement& element, const char* x, const char* y, const char* z) {
  const auto column_x = property_index(element, x), column_y = property_index(element, y),
             column_z = property_index(element, z);
  if (!column_x || !column_y || !column_z) return std::nullopt;
  return std::array<std::size_t, 3>{*column_x, *column_y, *column_z};
}

Eigen::Vector3d vector_in(const std::vector<double>& scalars, const Columns& at) {
  return {scalars[(*at)[0]], scalars[(*at)[1]], scalars[(*at)[2]]};
}

Result<void> read_element(const PlyElement& element, PlyValues& values, Model& model) {
  if (const Result<void> fits = check_size(element, values); !fits) return fits;
  const bool vertices = element.name == "vertex", faces = element.name == "face";
  const Columns position = columns(element, "x", "y", "z"), normal = columns(element, "nx", "ny", "nz");
  if (vertices && !position) return Error{ErrorKind::input, "its vertices lack x, y or z; export them"};
  if (vertices) model.positions.reserve(element.count);
  if (faces) model.triangles.reserve(element.count);
  std::vector<double> scalars(element.properties.size());
  std::vector<std::int64_t> list;
  for (std::uint64_t row = 0; row < element.count; ++row) {
    if (!read_row(element, values, scalars, list))
      return values.error(fmt::format("{} {} (from 0)", element.name, row));
    if (vertices) model.positions.push_back(vector_in(scalars, position));
    if (vertices && normal) model.normals.push_back(vector_in(scalars, normal));
    if (!faces) continue;
    if (const Result<void> done = append_polygon(list, model.positions.size(), model); !done)
      return Error{done.error().kind, fmt::format("face {} (from 0): {}", row, done.error().message)};
  }
  return {};
}

}  // namespace

Result<Model> parse_ply(Bytes bytes) {
  const Result<PlyHeader> header = parse_ply_header(bytes);
  if (!header) return header.error();
  PlyValues values(bytes.subspan(header->size), *header);
  Model model;
  for (const PlyElement& element : header->elements)
    if (const Result<void> read = read_element(element, values, model); !read) return read.error();
  if (model.positions.size() >= 0xFFFFFFFFU)
    return Error{ErrorKind::input, "it has more than 4,294,967,294 vertices; split it"};
  return model;
}

}  // namespace emap
