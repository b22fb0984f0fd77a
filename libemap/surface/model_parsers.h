#pragma once

// The parsers behind model_file.h, one a format, from bytes in memory. Errors do not name the file: the caller does.

#include <cstdint>
#include <span>

#include "libemap/surface/model_file.h"

namespace emap {

using Bytes = std::span<const std::uint8_t>;

thin::Result<Model> parse_ply(Bytes bytes);
thin::Result<Model> parse_obj(Bytes bytes);
thin::Result<Model> parse_off(Bytes bytes);
thin::Result<Model> parse_stl(Bytes bytes);
thin::Result<Model> parse_xyz(Bytes bytes);

// Appends the fan of triangles of a polygon. Error where an index is not in [0, vertex_count).
thin::Result<void> append_polygon(std::span<const std::int64_t> indices, std::size_t vertex_count, Model& model);

}  // namespace emap
