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

// Supported samples in each block.
struct Counts {
  std::uint32_t columns, rows;
  std::vector<std::uint32_t> values;

  std::uint32_t at(std::uint32_t row, std::uint32_t column) const {
    return row < rows && column < columns ? values[std::size_t{row} * columns + column] : 0;
  }
};

Counts halved(const Counts& fine) {
  Counts half{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
  half.values.resize(std::size_t{half.columns} * half.rows);
  for (std::uint32_t r = 0; r < fine.rows; ++r)
    for (std::uint32_t c = 0; c < fine.columns; ++c)
      half.values[std::size_t{r / 2} * half.columns + c / 2] += fine.values[std::size_t{r} * fine.columns + c];
  return half;
}

std::uint8_t class_of_share(std::uint32_t part, std::uint32_t whole) {
  if (part == 0) return 0;
  if (10 * part < whole) return 1;
  if (4 * part < whole) return 2;
  if (2 * part < whole) return 3;
  if (4 * part < 3 * whole) return 4;
  return part < whole ? 5 : 6;
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

std::vector<std::uint8_t> coefficient_visibility(std::uint32_t columns, std::uint32_t rows,
                                                 const std::vector<Band>& bands,
                                                 const std::vector<std::uint8_t>& mask) {
  assert(mask.size() == std::size_t{columns} * rows);
  std::vector<std::uint8_t> visibility(mask.size());
  std::vector<Counts> levels = {{columns, rows, {mask.begin(), mask.end()}}};
  for (const Band& band : bands) {
    while (levels.size() <= band.level) levels.push_back(halved(levels.back()));
    const Counts& counts = levels[band.level];
    // A high-pass function lies between two blocks.
    const std::uint32_t right = band.kind & 1, down = band.kind >> 1;
    const std::uint32_t whole = (1 + right) * (1 + down) << 2 * band.level;
    for (std::uint32_t r = 0; r < band.rows; ++r)
      for (std::uint32_t c = 0; c < band.columns; ++c) {
        std::uint32_t part = counts.at(r, c);
        if (right) part += counts.at(r, c + 1);
        if (down) part += counts.at(r + 1, c);
        if (right && down) part += counts.at(r + 1, c + 1);
        visibility[std::size_t{band.row + r} * columns + band.column + c] = class_of_share(part, whole);
      }
  }
  return visibility;
}

}  // namespace emap
