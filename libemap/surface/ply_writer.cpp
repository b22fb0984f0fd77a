#include <fmt/format.h>

#include <cassert>
#include <cstring>

#include "libemap/surface/model_file.h"
#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

constexpr const char* kColourProperties = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string header_text(std::size_t vertices, bool with_normals, std::optional<std::size_t> triangles,
                        const PlyOptions& options) {
  const char* type = options.precise ? "double" : "float";
  std::string text = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", vertices);
  for (const char* name : {"x", "y", "z"}) text += fmt::format("property {} {}\n", type, name);
  if (with_normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!options.vertex_colours.empty()) text += kColourProperties;
  if (triangles) text += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", *triangles);
  if (triangles && !options.triangle_colours.empty()) text += kColourProperties;
  return text + "end_header\n";
}

class ByteWriter {
 public:
  explicit ByteWriter(const std::string& header) : bytes_(header.begin(), header.end()) {}

  template <class Value>
  void append(Value value) {
    const std::size_t place = bytes_.size();
    bytes_.resize(place + sizeof(Value));
    std::memcpy(bytes_.data() + place, &value, sizeof(Value));
  }
  void append(const Eigen::Vector3d& vector, bool precise) {
    for (const double component : vector)
      if (precise)
        append(component);
      else
        append(static_cast<float>(component));
  }
  void append(const Colour& colour) { bytes_.insert(bytes_.end(), colour.begin(), colour.end()); }
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }

  thin::Result<void> write_to(const std::string& path) const { return thin::write_file_bytes(path, bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

void append_vertices(const std::vector<Eigen::Vector3d>& positions, const std::vector<Eigen::Vector3d>& normals,
                     const PlyOptions& options, ByteWriter& writer) {
  assert(options.vertex_colours.empty() || options.vertex_colours.size() == positions.size());
  writer.reserve(positions.size() * (3 * sizeof(double) + 3 * sizeof(float) + 3));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    writer.append(positions[i], options.precise);
    if (!normals.empty()) writer.append(normals[i], false);
    if (!options.vertex_colours.empty()) writer.append(options.vertex_colours[i]);
  }
}

}  // namespace

thin::Result<void> write_ply(const std::string& path, const Mesh& mesh, const PlyOptions& options) {
  assert(options.triangle_colours.empty() || options.triangle_colours.size() == mesh.triangles.size());
  ByteWriter writer(header_text(mesh.positions.size(), false, mesh.triangles.size(), options));
  append_vertices(mesh.positions, {}, options, writer);
  writer.reserve(mesh.triangles.size() * 16);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    writer.append(std::uint8_t{3});
    for (const std::uint32_t index : mesh.triangles[i]) writer.append(static_cast<std::int32_t>(index));
    if (!options.triangle_colours.empty()) writer.append(options.triangle_colours[i]);
  }
  return writer.write_to(path);
}

thin::Result<void> write_ply(const std::string& path, const PointSet& points, const PlyOptions& options) {
  ByteWriter writer(header_text(points.positions.size(), !points.normals.empty(), std::nullopt, options));
  append_vertices(points.positions, points.normals, options, writer);
  return writer.write_to(path);
}

}  // namespace emap
