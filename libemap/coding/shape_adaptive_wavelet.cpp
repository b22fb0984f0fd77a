#include "libemap/coding/shape_adaptive_wavelet.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

namespace emap {
namespace {

constexpr double kLifting[4] = {-1.586134342059924, -0.052980118572961, 0.882911075530934, 0.443506852043971};
constexpr double kScale = 1.149604398860241;
constexpr double kSingle = std::numbers::sqrt2;  // the low-pass filter's gain for constants

// Adds factor times both neighbours to every sample of parity `parity` in [begin, end), mirrored at the ends.
void lift(double* x, std::uint32_t begin, std::uint32_t end, std::uint32_t parity, double factor) {
  for (std::uint32_t p = begin + ((begin ^ parity) & 1); p < end; p += 2) {
    const double left = x[p > begin ? p - 1 : p + 1];
    const double right = x[p + 1 < end ? p + 1 : p - 1];
    x[p] += factor * (left + right);
  }
}

void scale(double* x, std::uint32_t begin, std::uint32_t end, double even, double odd) {
  for (std::uint32_t p = begin; p < end; ++p) x[p] *= p & 1 ? odd : even;
}

void analyse_run(double* x, std::uint32_t begin, std::uint32_t end) {
  if (end - begin == 1) {
    x[begin] *= kSingle;
    return;
  }
  for (std::uint32_t step = 0; step < 4; ++step) lift(x, begin, end, step % 2 == 0, kLifting[step]);
  scale(x, begin, end, kScale, 1 / kScale);
}

void synthesise_run(double* x, std::uint32_t begin, std::uint32_t end) {
  if (end - begin == 1) {
    x[begin] /= kSingle;
    return;
  }
  scale(x, begin, end, 1 / kScale, kScale);
  for (std::uint32_t step = 4; step-- > 0;) lift(x, begin, end, step % 2 == 0, -kLifting[step]);
}

template <class Function>
void for_runs(const std::uint8_t* mask, std::uint32_t length, const Function& function) {
  for (std::uint32_t begin = 0; begin < length;) {
    if (!mask[begin]) {
      ++begin;
      continue;
    }
    std::uint32_t end = begin + 1;
    while (end < length && mask[end]) ++end;
    function(begin, end);
    begin = end;
  }
}

// Where position p of a run goes on a line of `length` samples: low-pass in front, high-pass behind.
std::uint32_t place(std::uint32_t p, bool single, std::uint32_t length) {
  return p % 2 == 0 || single ? p / 2 : (length + 1) / 2 + p / 2;
}

// One line of a map, gathered and scattered with a stride; scratch space is kept between lines.
class Line {
 public:
  void load(const std::uint8_t* mask, std::size_t stride, std::uint32_t length) {
    stride_ = stride;
    mask_.resize(length);
    for (std::uint32_t i = 0; i < length; ++i) mask_[i] = mask[i * stride];
  }

  void analyse(double* samples) {
    const auto length = static_cast<std::uint32_t>(mask_.size());
    values_.resize(length);
    for (std::uint32_t i = 0; i < length; ++i) values_[i] = samples[i * stride_];
    for (std::uint32_t i = 0; i < length; ++i) samples[i * stride_] = 0;
    for_runs(mask_.data(), length, [&](std::uint32_t begin, std::uint32_t end) {
      analyse_run(values_.data(), begin, end);
      for (std::uint32_t p = begin; p < end; ++p) samples[place(p, end - begin == 1, length) * stride_] = values_[p];
    });
  }

  void synthesise(double* samples) {
    const auto length = static_cast<std::uint32_t>(mask_.size());
    values_.assign(length, 0);
    for_runs(mask_.data(), length, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t p = begin; p < end; ++p) values_[p] = samples[place(p, end - begin == 1, length) * stride_];
      synthesise_run(values_.data(), begin, end);
    });
    for (std::uint32_t i = 0; i < length; ++i) samples[i * stride_] = values_[i];
  }

  // Moves the loaded mask itself to where the coefficients go.
  void move_mask(std::uint8_t* mask) const {
    const auto length = static_cast<std::uint32_t>(mask_.size());
    for (std::uint32_t i = 0; i < length; ++i) mask[i * stride_] = 0;
    for_runs(mask_.data(), length, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t p = begin; p < end; ++p) mask[place(p, end - begin == 1, length) * stride_] = 1;
    });
  }

 private:
  std::size_t stride_ = 1;
  std::vector<std::uint8_t> mask_;
  std::vector<double> values_;
};

struct Size {
  std::uint32_t columns, rows;
};

Size half(Size size) {
  return {(size.columns + 1) / 2, (size.rows + 1) / 2};
}

// The masks before each step: rows of level 1, columns of level 1, rows of level 2, ..., and last the support.
std::vector<std::vector<std::uint8_t>> masks_of_steps(Size size, std::uint32_t levels, std::vector<std::uint8_t> mask) {
  const std::uint32_t stride = size.columns;
  std::vector<std::vector<std::uint8_t>> masks = {std::move(mask)};
  Line line;
  for (std::uint32_t level = 0; level < levels; ++level, size = half(size)) {
    masks.push_back(masks.back());
    for (std::uint32_t r = 0; r < size.rows; ++r) {
      std::uint8_t* row = masks.back().data() + std::size_t{r} * stride;
      line.load(row, 1, size.columns);
      line.move_mask(row);
    }
    masks.push_back(masks.back());
    for (std::uint32_t c = 0; c < size.columns; ++c) {
      line.load(masks.back().data() + c, stride, size.rows);
      line.move_mask(masks.back().data() + c);
    }
  }
  return masks;
}

}  // namespace

std::uint32_t wavelet_levels(std::uint32_t columns, std::uint32_t rows) {
  std::uint32_t levels = 0;
  for (std::uint32_t side = std::min(columns, rows); side >= 16 && levels < 6; side = (side + 1) / 2) ++levels;
  return levels;
}

std::vector<Band> wavelet_bands(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels) {
  std::vector<Band> bands;
  Size size{columns, rows};
  for (std::uint32_t level = 1; level <= levels; ++level) {
    const Size low = half(size);
    bands.push_back({low.rows, low.columns, size.rows - low.rows, size.columns - low.columns, level, 3});
    bands.push_back({low.rows, 0, size.rows - low.rows, low.columns, level, 2});
    bands.push_back({0, low.columns, low.rows, size.columns - low.columns, level, 1});
    size = low;
  }
  bands.push_back({0, 0, size.rows, size.columns, levels, 0});
  std::reverse(bands.begin(), bands.end());
  std::erase_if(bands, [](const Band& band) { return band.rows == 0 || band.columns == 0; });
  return bands;
}

std::vector<std::uint8_t> shape_adaptive_support(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                                                 std::vector<std::uint8_t> mask) {
  return std::move(masks_of_steps({columns, rows}, levels, std::move(mask)).back());
}

void shape_adaptive_analysis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                             const std::vector<std::uint8_t>& mask, std::vector<double>& samples) {
  assert(mask.size() == std::size_t{columns} * rows && samples.size() == mask.size());
  const auto masks = masks_of_steps({columns, rows}, levels, mask);
  Line line;
  Size size{columns, rows};
  for (std::uint32_t level = 0; level < levels; ++level, size = half(size)) {
    for (std::uint32_t r = 0; r < size.rows; ++r) {
      line.load(masks[2 * level].data() + std::size_t{r} * columns, 1, size.columns);
      line.analyse(samples.data() + std::size_t{r} * columns);
    }
    for (std::uint32_t c = 0; c < size.columns; ++c) {
      line.load(masks[2 * level + 1].data() + c, columns, size.rows);
      line.analyse(samples.data() + c);
    }
  }
}

void shape_adaptive_synthesis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                              const std::vector<std::uint8_t>& mask, std::vector<double>& coefficients) {
  assert(mask.size() == std::size_t{columns} * rows && coefficients.size() == mask.size());
  const auto masks = masks_of_steps({columns, rows}, levels, mask);
  std::vector<Size> sizes = {{columns, rows}};
  for (std::uint32_t level = 0; level < levels; ++level) sizes.push_back(half(sizes.back()));
  Line line;
  for (std::uint32_t level = levels; level-- > 0;) {
    const Size size = sizes[level];
    for (std::uint32_t c = 0; c < size.columns; ++c) {
      line.load(masks[2 * level + 1].data() + c, columns, size.rows);
      line.synthesise(coefficients.data() + c);
    }
    for (std::uint32_t r = 0; r < size.rows; ++r) {
      line.load(masks[2 * level].data() + std::size_t{r} * columns, 1, size.columns);
      line.synthesise(coefficients.data() + std::size_t{r} * columns);
    }
  }
}

}  // namespace emap
