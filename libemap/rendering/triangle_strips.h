#pragma once

// The canonical triangulation of a map as one triangle strip (thesis, 5.2.2 and figure 5.5).

#include <cstdint>
#include <functional>
#include <vector>

#include "libemap/elevation/elevation_map.h"

namespace emap {

// Squares by the sample of their lowest row and column: [first, last).
struct SquareRange {
  std::uint32_t first_column, last_column, first_row, last_row;
};

// Appends the strip of these squares, row by row in bands of 64 columns, so that what one row has passed through a
// vertex cache is still there when the next one needs it. Diagonals are those of visit_grid_triangles(); triangles
// steeper than steepest_slope (a tangent) are left out, as canonical_mesh() does. Breaks are bridged by triangles
// without an area. index_of(row, column): what stands in the strip for a sample.
void append_strip(const ElevationPatch& map, double spacing, double steepest_slope, const SquareRange& squares,
                  const std::function<std::uint16_t(std::uint32_t, std::uint32_t)>& index_of,
                  std::vector<std::uint16_t>& strip);

}  // namespace emap
