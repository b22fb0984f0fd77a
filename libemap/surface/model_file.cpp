#include "libemap/surface/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "libemap/surface/model_parsers.h"
#include "libthin/foundation/file_bytes.h"

namespace emap {
namespace {

using thin::Error;
using thin::ErrorKind;
using thin::Result;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Result<Model> parse(const std::string& extension, Bytes bytes) {
  if (extension == ".ply") return parse_ply(bytes);
  if (extension == ".obj") return parse_obj(bytes);
  if (extension == ".off") return parse_off(bytes);
  if (extension == ".stl") return parse_stl(bytes);
  if (extension == ".xyz") return parse_xyz(bytes);
  return Error{ErrorKind::input,
               fmt::format("the extension \"{}\" names no format that is read here; convert it to PLY, "
                           "OBJ, OFF, STL or XYZ",
                           extension)};
}

Result<void> check_finite(const std::vector<Eigen::Vector3d>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!positions[i].allFinite())
      return Error{ErrorKind::input,
                   fmt::format("vertex {} (from 0) lies at ({}, {}, {}); remove it or give it a place", i,
                               positions[i].x(), positions[i].y(), positions[i].z())};
  return {};
}

// Unit lengths; none at all where one of them has no direction.
void normalise_normals(Model& model) {
  for (Eigen::Vector3d& normal : model.normals) {
    const double length = normal.norm();
    if (!(length > 0) || !std::isfinite(length)) return model.normals.clear();
    normal /= length;
  }
}

Error named(Error error, const std::string& path) {
  error.message = "cannot use " + path + ": " + error.message;
  return error;
}

}  // namespace

Result<void> append_polygon(std::span<const std::int64_t> indices, std::size_t vertex_count, Model& model) {
  for (const std::int64_t index : indices)
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count)
      return Error{ErrorKind::input,
                   fmt::format("it names vertex {}, but there are {} vertices (numbered from 0)", index, vertex_count)};
  for (std::size_t corner = 2; corner < indices.size(); ++corner)
    model.triangles.push_back({static_cast<std::uint32_t>(indices[0]), static_cast<std::uint32_t>(indices[corner - 1]),
                               static_cast<std::uint32_t>(indices[corner])});
  return {};
}

Result<Model> read_model(const std::string& path) {
  const Result<std::vector<std::uint8_t>> bytes = thin::read_file_bytes(path);
  if (!bytes) return bytes.error();
  Result<Model> model = parse(lower_extension(path), *bytes);
  if (!model) return named(model.error(), path);
  if (const Result<void> finite = check_finite(model->positions); !finite) return named(finite.error(), path);
  normalise_normals(*model);
  return model;
}

Result<Mesh> read_mesh(const std::string& path) {
  Result<Model> model = read_model(path);
  if (!model) return model.error();
  if (model->triangles.empty())
    return named({ErrorKind::input, fmt::format("it has {} vertices but no triangles; read it as points (--points)",
                                                model->positions.size())},
                 path);
  return mesh_of(*std::move(model));
}

Result<PointSet> read_points(const std::string& path) {
  Result<Model> model = read_model(path);
  if (!model) return model.error();
  if (model->positions.empty()) return named({ErrorKind::input, "it has no points"}, path);
  return points_of(*std::move(model));
}

Mesh mesh_of(Model model) {
  return {std::move(model.positions), std::move(model.triangles)};
}

PointSet points_of(Model model) {
  return {std::move(model.positions), std::move(model.normals)};
}

}  // namespace emap
