#include "libemap/elevation/map_grid.h"

#include <algorithm>

namespace emap {

Eigen::Vector3d over_plane(const BasePlane& plane, double spacing, const Eigen::Vector3d& position) {
  const Eigen::Vector3d offset = position - plane.origin;
  return {plane.axis_u.dot(offset) / spacing, plane.axis_v.dot(offset) / spacing, plane.normal.dot(offset)};
}

ElevationPatch empty_patch(const BasePlane& plane, double last_u, double last_v) {
  constexpr double kRounding = 1e-6;  // samples
  ElevationPatch patch;
  patch.plane = plane;
  if (last_u < -kRounding || last_v < -kRounding) return patch;
  patch.columns = static_cast<std::uint32_t>(last_u + kRounding) + 1;
  patch.rows = static_cast<std::uint32_t>(last_v + kRounding) + 1;
  patch.mask.assign(std::size_t{patch.rows} * patch.columns, 0);
  patch.elevation.assign(patch.mask.size(), 0);
  return patch;
}

void crop(ElevationPatch& patch) {
  std::uint32_t columns = 0, rows = 0;
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      if (patch.mask[std::size_t{row} * patch.columns + column]) {
        rows = row + 1;
        columns = std::max(columns, column + 1);
      }
  for (std::size_t row = 1; row < rows; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(row * patch.columns), to = static_cast<std::ptrdiff_t>(row * columns);
    std::copy_n(patch.mask.begin() + from, columns, patch.mask.begin() + to);
    std::copy_n(patch.elevation.begin() + from, columns, patch.elevation.begin() + to);
  }
  patch.columns = columns;
  patch.rows = rows;
  patch.mask.resize(std::size_t{rows} * columns);
  patch.elevation.resize(std::size_t{rows} * columns);
}

ShiftedOrigin set_margin(std::uint32_t margin, ElevationPatch& patch) {
  std::uint32_t first_column = patch.columns, first_row = patch.rows, columns = 0, rows = 0;
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column)
      if (patch.mask[std::size_t{row} * patch.columns + column]) {
        first_column = std::min(first_column, column);
        first_row = std::min(first_row, row);
        columns = std::max(columns, column + 1);
        rows = std::max(rows, row + 1);
      }
  if (columns == 0) {
    patch.columns = patch.rows = 0;
    patch.mask.clear();
    patch.elevation.clear();
    return {0, 0};
  }
  ElevationPatch framed = patch;
  framed.columns = columns - first_column + 2 * margin;
  framed.rows = rows - first_row + 2 * margin;
  framed.mask.assign(std::size_t{framed.rows} * framed.columns, 0);
  framed.elevation.assign(framed.mask.size(), 0);
  for (std::uint32_t row = first_row; row < rows; ++row) {
    const auto from = static_cast<std::ptrdiff_t>(std::size_t{row} * patch.columns + first_column);
    const auto to = static_cast<std::ptrdiff_t>(std::size_t{row - first_row + margin} * framed.columns + margin);
    std::copy_n(patch.mask.begin() + from, columns - first_column, framed.mask.begin() + to);
    std::copy_n(patch.elevation.begin() + from, columns - first_column, framed.elevation.begin() + to);
  }
  patch = std::move(framed);
  return {static_cast<std::int32_t>(first_column) - static_cast<std::int32_t>(margin),
          static_cast<std::int32_t>(first_row) - static_cast<std::int32_t>(margin)};
}

}  // namespace emap
