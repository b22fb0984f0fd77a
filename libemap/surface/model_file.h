#pragma once

// Model files: PLY (binary of both byte orders, ASCII), OBJ, OFF, STL (binary, ASCII) and XYZ, told apart by their
// extension, whatever its case. Polygons are cut into fans of triangles; STL's corners are welded where they are equal.
//
// Errors name the file, the line or element, the value and what to do: input, where the file can't be used; incomplete,
// where it ends early; temporary or internal, where the machine fails.

#include <optional>
#include <string>

#include "libemap/surface/surface.h"
#include "libthin/foundation/result.h"

namespace emap {

// What a file holds: a mesh where it has triangles, a point set otherwise.
struct Model {
  std::vector<Eigen::Vector3d> positions;               // all finite
  std::vector<Eigen::Vector3d> normals;                 // of unit length, one for each position; or empty
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into positions; may repeat a vertex

  bool is_mesh() const { return !triangles.empty(); }
};

thin::Result<Model> read_model(const std::string& path);

// Error where there are no triangles.
thin::Result<Mesh> read_mesh(const std::string& path);

// The vertices, where the file holds a mesh. Error where there are none. Normals are dropped unless all have a length.
thin::Result<PointSet> read_points(const std::string& path);

Mesh mesh_of(Model model);
PointSet points_of(Model model);

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

// Binary little-endian PLY; positions as float, or as double where `precise`.
struct PlyOptions {
  bool precise = false;
  std::vector<Colour> triangle_colours = {};  // one for each triangle, or empty
  std::vector<Colour> vertex_colours = {};    // one for each position, or empty
};
thin::Result<void> write_ply(const std::string& path, const Mesh& mesh, const PlyOptions& options = {});
thin::Result<void> write_ply(const std::string& path, const PointSet& points, const PlyOptions& options = {});

}  // namespace emap
