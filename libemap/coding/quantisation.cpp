#include "libemap/coding/quantisation.h"

#include "libemap/coding/coefficient_support.h"

namespace emap {

QuantisedMap quantised_map(std::uint32_t columns, std::uint32_t rows, const std::vector<std::uint8_t>& mask) {
  const std::uint32_t levels = rectangular_levels(columns, rows);
  QuantisedMap map;
  map.columns = columns;
  map.rows = rows;
  map.bands = wavelet_bands(columns, rows, levels);
  map.support = coefficient_support(columns, rows, levels, mask);
  map.visibility = coefficient_visibility(columns, rows, map.bands, mask);
  map.values.resize(mask.size());
  return map;
}

}  // namespace emap
