#pragma once

// The canonical triangulation of one elevation map, triangle by triangle.

#include <array>
#include <cmath>
#include <cstdint>

#include "libemap/elevation/elevation_map.h"

namespace emap {

// Places in the map (row * columns + column), counter-clockwise seen against the normal.
using GridTriangle = std::array<std::size_t, 3>;

// Whether the square whose lowest row and column are those of sample `a` is cut from its lower right to its upper left:
// along its shorter diagonal, and the other one where they are equal. REQUIRES: all four samples supported
inline bool falls(const ElevationPatch& patch, std::size_t a) {
  const std::size_t b = a + 1, d = a + patch.columns, c = d + 1;
  return std::abs(patch.elevation[a] - patch.elevation[c]) > std::abs(patch.elevation[b] - patch.elevation[d]);
}

// Calls visit(triangle) for the triangles of each square: two along its shorter diagonal (the one from the sample of
// the lowest row and column, where they are equal), one where one of its samples is missing.
template <class Visitor>
void visit_grid_triangles(const ElevationPatch& patch, const Visitor& visit) {
  for (std::size_t row = 0; row + 1 < patch.rows; ++row)
    for (std::size_t column = 0; column + 1 < patch.columns; ++column) {
      const std::size_t a = row * patch.columns + column, b = a + 1, d = a + patch.columns, c = d + 1;
      const int supported = patch.mask[a] + patch.mask[b] + patch.mask[c] + patch.mask[d];
      if (supported < 3) continue;
      if (supported == 3) {
        if (!patch.mask[a]) visit(GridTriangle{b, c, d});
        if (!patch.mask[b]) visit(GridTriangle{a, c, d});
        if (!patch.mask[c]) visit(GridTriangle{a, b, d});
        if (!patch.mask[d]) visit(GridTriangle{a, b, c});
      } else if (!falls(patch, a)) {
        visit(GridTriangle{a, b, c});
        visit(GridTriangle{a, c, d});
      } else {
        visit(GridTriangle{a, b, d});
        visit(GridTriangle{b, c, d});
      }
    }
}

// Tangent of the triangle's angle to the base plane.
inline double slope_of(const ElevationPatch& patch, const GridTriangle& triangle, double spacing) {
  // Of its three sides one runs along u and one along v.
  const auto columns = static_cast<std::size_t>(patch.columns);
  double rise_u = 0, rise_v = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (triangle[j] == triangle[i] + 1 && triangle[j] % columns != 0)
        rise_u = patch.elevation[triangle[j]] - patch.elevation[triangle[i]];
      if (triangle[j] == triangle[i] + columns) rise_v = patch.elevation[triangle[j]] - patch.elevation[triangle[i]];
    }
  return std::hypot(rise_u, rise_v) / spacing;
}

}  // namespace emap
