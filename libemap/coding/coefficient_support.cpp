#include "libemap/coding/coefficient_support.h"

#include <algorithm>
#include <cassert>

namespace emap {
namespace {

struct Image {
  std::uint32_t columns, rows;
  std::vector<std::uint8_t> values;

  std::uint8_t at(std::uint32_t row, std::uint32_t column) const { return values[std::size_t{row} * columns + column]; }
};

// Along rows: the low-pass half (high = 0) or high-pass half (high = 1) of the positions that matter.
Image halve_rows(const Image& image, std::uint32_t high) {
  Image half{(image.columns + 1 - high) / 2, image.rows, {}};
  half.values.reserve(std::size_t{half.columns} * half.rows);
  for (std::uint32_t r = 0; r < image.rows; ++r)
    for (std::uint32_t n = 0; n < half.columns; ++n) {
      const std::uint32_t middle = 2 * n + high;
      half.values.push_back(image.at(r, middle > 0 ? middle - 1 : middle) | image.at(r, middle) |
                            image.at(r, std::min(middle + 1, image.columns - 1)));
    }
  return half;
}

Image halve_columns(const Image& image, std::uint32_t high) {
  Image half{image.columns, (image.rows + 1 - high) / 2, {}};
  half.values.reserve(std::size_t{half.columns} * half.rows);
  for (std::uint32_t n = 0; n < half.rows; ++n)
    for (std::uint32_t c = 0; c < image.columns; ++c) {
      const std::uint32_t middle = 2 * n + high;
      half.values.push_back(image.at(middle > 0 ? middle - 1 : middle, c) | image.at(middle, c) |
                            image.at(std::min(middle + 1, image.rows - 1), c));
    }
  return half;
}

}  // namespace

std::uint32_t rectangular_levels(std::uint32_t columns, std::uint32_t rows) {
  std::uint32_t levels = 1;
  for (std::uint32_t side = (std::max(columns, rows) + 1) / 2; side > 4 && levels < 8; side = (side + 1) / 2) ++levels;
  return levels;
}

std::vector<std::uint8_t> coefficient_support(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                              const std::vector<std::uint8_t>& mask) {
  assert(mask.size() == std::size_t{columns} * rows && levels > 0);
  std::vector<std::uint8_t> support(mask.size());
  if (mask.empty()) return support;
  const auto place = [&](const Image& image, std::uint32_t row, std::uint32_t column) {
    for (std::uint32_t r = 0; r < image.rows; ++r)
      std::copy_n(image.values.begin() + std::size_t{r} * image.columns, image.columns,
                  support.begin() + std::size_t{row + r} * columns + column);
  };

  Image low{columns, rows, mask};
  for (std::uint32_t level = 1; level <= levels; ++level) {
    const Image left = halve_rows(low, 0), right = halve_rows(low, 1);
    const Image next = halve_columns(left, 0);
    if (level > 1) {
      place(halve_columns(right, 0), 0, next.columns);
      place(halve_columns(left, 1), next.rows, 0);
      place(halve_columns(right, 1), next.rows, next.columns);
    }
    low = next;
  }
  std::fill(low.values.begin(), low.values.end(), std::uint8_t{1});
  place(low, 0, 0);
  return support;
}

}  // namespace emap
