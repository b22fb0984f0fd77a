#include "libemap/coding/mask_refinement.h"

#include <cassert>

namespace emap {

std::vector<std::uint8_t> coarse_mask(std::uint32_t columns, std::uint32_t rows,
                                      const std::vector<std::uint8_t>& mask) {
  assert(mask.size() == std::size_t{columns} * rows);
  std::vector<std::uint8_t> coarse;
  coarse.reserve(std::size_t{halved(columns)} * halved(rows));
  for (std::uint32_t r = 0; r < rows; r += 2)
    for (std::uint32_t c = 0; c < columns; c += 2) coarse.push_back(mask[std::size_t{r} * columns + c]);
  return coarse;
}

std::vector<std::uint8_t> refined_mask(std::uint32_t columns, std::uint32_t rows,
                                       const std::vector<std::uint8_t>& mask) {
  assert(mask.size() == std::size_t{columns} * rows);
  const std::uint32_t fine_columns = doubled(columns), fine_rows = doubled(rows);
  std::vector<std::uint8_t> fine(std::size_t{fine_columns} * fine_rows);
  for (std::uint32_t r = 0; r < fine_rows; ++r)
    for (std::uint32_t c = 0; c < fine_columns; ++c) {
      const std::uint8_t* first = mask.data() + std::size_t{r / 2} * columns + c / 2;
      const std::uint32_t right = c % 2, down = (r % 2) * columns;
      // On a coarse sample these are four times the same, between two of them twice both.
      const int supported = first[0] + first[right] + first[down] + first[down + right];
      fine[std::size_t{r} * fine_columns + c] = supported >= 3;
    }
  return fine;
}

}  // namespace emap
