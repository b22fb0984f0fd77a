#pragma once

// The header of a PLY file: which elements follow, in which types.

#include <optional>
#include <string>
#include <vector>

#include "libemap/surface/model_parsers.h"

namespace emap {

enum class PlyEncoding { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type = {};  // where it is a list

  // Bytes that one value takes at least, in a binary file.
  std::size_t least_size() const { return count_type ? size_of(*count_type) : size_of(type); }
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;   // bytes before the first element
  std::size_t lines = 0;  // lines before the first element
};

thin::Result<PlyHeader> parse_ply_header(Bytes bytes);

}  // namespace emap
