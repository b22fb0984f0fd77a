#include "libemap/coding/map_slope.h"

#include <cmath>

namespace emap {
namespace {

// Difference of elevations across one sample along an axis, from the neighbours that there are.
double slope(const ElevationPatch& patch, std::size_t index, bool before, bool behind, std::size_t stride) {
  before = before && patch.mask[index - stride];
  behind = behind && patch.mask[index + stride];
  const double first = before ? patch.elevation[index - stride] : patch.elevation[index];
  const double last = behind ? patch.elevation[index + stride] : patch.elevation[index];
  return before && behind ? (last - first) / 2 : last - first;
}

template <class Function>
void for_cosines(const ElevationPatch& patch, double spacing, const Function& function) {
  for (std::uint32_t row = 0; row < patch.rows; ++row)
    for (std::uint32_t column = 0; column < patch.columns; ++column) {
      const std::size_t index = std::size_t{row} * patch.columns + column;
      if (!patch.mask[index]) continue;
      const double u = slope(patch, index, column > 0, column + 1 < patch.columns, 1) / spacing;
      const double v = slope(patch, index, row > 0, row + 1 < patch.rows, patch.columns) / spacing;
      function(1 / std::sqrt(1 + u * u + v * v));
    }
}

}  // namespace

double mean_surface_weight(const ElevationPatch& patch, double spacing) {
  double sum = 0, count = 0;
  for_cosines(patch, spacing, [&](double cosine) {
    sum += cosine;
    ++count;
  });
  return count > 0 ? sum / count : 1;
}

double surface_area(const ElevationPatch& patch, double spacing) {
  double area = 0;
  for_cosines(patch, spacing, [&](double cosine) { area += spacing * spacing / cosine; });
  return area;
}

}  // namespace emap
