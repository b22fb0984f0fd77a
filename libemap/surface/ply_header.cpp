#include "libemap/surface/ply_header.h"

#include <fmt/format.h>

#include "libemap/surface/text_scanner.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

std::optional<PlyType> type_named(std::string_view name) {
  if (name == "char" || name == "int8") return PlyType::int8;
  if (name == "uchar" || name == "uint8") return PlyType::uint8;
  if (name == "short" || name == "int16") return PlyType::int16;
  if (name == "ushort" || name == "uint16") return PlyType::uint16;
  if (name == "int" || name == "int32") return PlyType::int32;
  if (name == "uint" || name == "uint32") return PlyType::uint32;
  if (name == "float" || name == "float32") return PlyType::float32;
  if (name == "double" || name == "float64") return PlyType::float64;
  return std::nullopt;
}

std::optional<PlyEncoding> encoding_named(std::string_view name) {
  if (name == "ascii") return PlyEncoding::ascii;
  if (name == "binary_little_endian") return PlyEncoding::little_endian;
  if (name == "binary_big_endian") return PlyEncoding::big_endian;
  return std::nullopt;
}

bool is_floating(PlyType type) {
  return type == PlyType::float32 || type == PlyType::float64;
}

std::optional<PlyProperty> parse_property(std::string_view rest) {
  PlyProperty property;
  std::string_view word = TextScanner::take_word(rest);
  if (word == "list") {
    property.count_type = type_named(TextScanner::take_word(rest));
    if (!property.count_type || is_floating(*property.count_type)) return std::nullopt;
    word = TextScanner::take_word(rest);
  }
  const std::optional<PlyType> type = type_named(word);
  property.name = TextScanner::take_word(rest);
  if (!type || property.name.empty()) return std::nullopt;
  property.type = *type;
  return property;
}

// One line of the header into `header`; false where it makes no sense.
bool parse_line(std::string_view line, PlyHeader& header) {
  std::string_view rest = line;
  const std::string_view keyword = TextScanner::take_word(rest);
  if (keyword == "comment" || keyword == "obj_info") return true;
  if (keyword == "format") {
    const std::optional<PlyEncoding> encoding = encoding_named(TextScanner::take_word(rest));
    if (encoding) header.encoding = *encoding;
    return encoding.has_value();
  }
  if (keyword == "element") {
    PlyElement element;
    element.name = TextScanner::take_word(rest);
    const auto count = TextScanner::take_number<std::uint64_t>(rest);
    element.count = count.value_or(0);
    header.elements.push_back(element);
    return count.has_value();
  }
  if (keyword != "property" || header.elements.empty()) return false;
  const std::optional<PlyProperty> property = parse_property(rest);
  if (property) header.elements.back().properties.push_back(*property);
  return property.has_value();
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

Result<PlyHeader> parse_ply_header(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with("ply")) return Error{ErrorKind::input, "it does not begin with \"ply\"; is it another format?"};
  PlyHeader header;
  bool has_format = false;
  for (std::size_t begin = 0; begin < text.size(); ++header.lines) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) break;
    const std::string_view line = TextScanner::trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (header.lines == 0 || line.empty()) continue;
    if (line == "end_header") {
      header.size = begin;
      ++header.lines;
      if (has_format) return header;
      return Error{ErrorKind::input, "its header has no \"format\" line; add one"};
    }
    has_format = has_format || line.starts_with("format");
    if (!parse_line(line, header))
      return Error{ErrorKind::input,
                   fmt::format("line {} of its header makes no sense: \"{}\"", header.lines + 1, line.substr(0, 80))};
  }
  return Error{ErrorKind::incomplete, "its header has no end_header: the file is cut off"};
}

}  // namespace emap
