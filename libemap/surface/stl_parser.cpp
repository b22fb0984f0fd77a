// STL: triangles by their corners, binary or as text. Corners at the same place become one vertex.

#include <fmt/format.h>

#include <cstring>
#include <unordered_map>

#include "libemap/surface/model_parsers.h"
#include "libemap/surface/text_scanner.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

constexpr std::size_t kBinaryHeaderSize = 84, kBinaryTriangleSize = 50, kCountPlace = 80;

class VertexWelder {
 public:
  explicit VertexWelder(Model& model) : model_(model) {}

  std::uint32_t index_of(const Eigen::Vector3d& position) {
    // -0 and 0 are one place.
    const Eigen::Vector3d place = position.array() + 0.0;
    const auto [entry, added] = vertices_.try_emplace({place.x(), place.y(), place.z()}, next_);
    if (added) model_.positions.push_back(place), ++next_;
    return entry->second;
  }

 private:
  using Key = std::array<double, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t hash = 0;
      for (const double component : key) hash = (hash ^ std::hash<double>()(component)) * 0x9E3779B97F4A7C15ULL;
      return hash ^ (hash >> 32);
    }
  };
  Model& model_;
  std::unordered_map<Key, std::uint32_t, Hash> vertices_;
  std::uint32_t next_ = 0;
};

std::uint32_t triangle_count(Bytes bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kCountPlace, sizeof(count));
  return count;
}

// Some binary files begin with "solid" too: the size decides.
bool is_binary(Bytes bytes) {
  if (bytes.size() >= kBinaryHeaderSize &&
      bytes.size() == kBinaryHeaderSize + kBinaryTriangleSize * triangle_count(bytes))
    return true;
  return bytes.size() < 5 || std::memcmp(bytes.data(), "solid", 5) != 0;
}

Result<Model> parse_binary(Bytes bytes) {
  if (bytes.size() < kBinaryHeaderSize ||
      (bytes.size() - kBinaryHeaderSize) / kBinaryTriangleSize < triangle_count(bytes))
    return Error{ErrorKind::incomplete,
                 fmt::format("{} bytes do not hold the triangles that it promises: it is cut off, or "
                             "no STL",
                             bytes.size())};
  Model model;
  VertexWelder welder(model);
  for (std::uint32_t i = 0; i < triangle_count(bytes); ++i) {
    std::array<float, 12> values;  // the normal, three corners
    std::memcpy(values.data(), bytes.data() + kBinaryHeaderSize + kBinaryTriangleSize * i, sizeof(values));
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t corner = 0; corner < 3; ++corner)
      triangle[corner] = welder.index_of(Eigen::Vector3f(values.data() + 3 + 3 * corner).cast<double>());
    model.triangles.push_back(triangle);
  }
  return model;
}

Result<Model> parse_text(Bytes bytes) {
  TextScanner scanner(bytes);
  Model model;
  VertexWelder welder(model);
  std::vector<std::int64_t> corners;
  while (std::optional<std::string_view> line = scanner.next_line()) {
    const std::string_view keyword = TextScanner::take_word(*line);
    if (keyword == "vertex") {
      Eigen::Vector3d position;
      for (double& component : position) {
        const auto number = TextScanner::take_number<double>(*line);
        if (!number) return Error{ErrorKind::input, scanner.at_line() + ": a vertex is three numbers"};
        component = *number;
      }
      corners.push_back(welder.index_of(position));
    } else if (keyword == "endloop") {
      if (const Result<void> done = append_polygon(corners, model.positions.size(), model); !done) return done.error();
      corners.clear();
    }
  }
  if (!corners.empty()) return Error{ErrorKind::incomplete, "it ends within a triangle: the file is cut off"};
  return model;
}

}  // namespace

Result<Model> parse_stl(Bytes bytes) {
  return is_binary(bytes) ? parse_binary(bytes) : parse_text(bytes);
}

}  // namespace emap
