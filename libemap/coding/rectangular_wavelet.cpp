#include "libemap/coding/rectangular_wavelet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace emap {
namespace {

constexpr std::uint32_t kMostLevels = 12;

// Index mirrored at 0 and at length - 1.
std::uint32_t mirrored(std::int64_t i, std::uint32_t length) {
  const std::int64_t last = std::int64_t{length} - 1;
  if (last == 0) return 0;
  while (i < 0 || i > last) i = i < 0 ? -i : 2 * last - i;
  return static_cast<std::uint32_t>(i);
}

// A line of numbers, or a column of rows: what lifting does to one it does to the other.
struct Numbers {
  double* values;
  std::uint32_t length;

  void add(std::uint32_t target, double factor, std::uint32_t a, std::uint32_t b, std::uint32_t far_a,
           std::uint32_t far_b) const {
    values[target] += factor * (9 * (values[a] + values[b]) - (values[far_a] + values[far_b]));
  }
};

struct Rows {
  double* values;
  std::uint32_t length;
  std::size_t stride;
  std::uint32_t columns;

  double* row(std::uint32_t r) const { return values + r * stride; }
  void add(std::uint32_t target, double factor, std::uint32_t a, std::uint32_t b, std::uint32_t far_a,
           std::uint32_t far_b) const {
    double* out = row(target);
    const double *ra = row(a), *rb = row(b), *rfa = row(far_a), *rfb = row(far_b);
    for (std::uint32_t c = 0; c < columns; ++c) out[c] += factor * (9 * (ra[c] + rb[c]) - (rfa[c] + rfb[c]));
  }
};

template <class Line>
void lift(const Line& line, std::uint32_t parity, double factor) {
  const std::uint32_t n = line.length;
  for (std::uint32_t i = parity; i < n; i += 2) {
    if (i >= 3 && i + 3 < n)
      line.add(i, factor, i - 1, i + 1, i - 3, i + 3);
    else
      line.add(i, factor, mirrored(std::int64_t{i} - 1, n), mirrored(i + 1, n), mirrored(std::int64_t{i} - 3, n),
               mirrored(i + 3, n));
  }
}

template <class Line>
void analyse(const Line& line) {
  if (line.length < 2) return;
  lift(line, 1, -1.0 / 16);
  lift(line, 0, 1.0 / 32);
}

template <class Line>
void synthesise(const Line& line) {
  if (line.length < 2) return;
  lift(line, 0, -1.0 / 32);
  lift(line, 1, 1.0 / 16);
}

// Even positions to the front, odd ones behind them, or back.
std::uint32_t unmixed(std::uint32_t i, std::uint32_t length) {
  return i % 2 == 0 ? i / 2 : (length + 1) / 2 + i / 2;
}

struct Size {
  std::uint32_t columns, rows;
};

class Level {
 public:
  Level(std::vector<double>& image, std::uint32_t stride, Size size) : image_(image), stride_(stride), size_(size) {
    scratch_.resize(std::size_t{size.columns} * size.rows);
  }

  void analyse_all() {
    for (std::uint32_t r = 0; r < size_.rows; ++r) {
      analyse(Numbers{row(r), size_.columns});
      for (std::uint32_t c = 0; c < size_.columns; ++c) scratch_row(r)[unmixed(c, size_.columns)] = row(r)[c];
    }
    analyse(Rows{scratch_.data(), size_.rows, size_.columns, size_.columns});
    for (std::uint32_t r = 0; r < size_.rows; ++r)
      std::copy_n(scratch_row(r), size_.columns, row(unmixed(r, size_.rows)));
  }

  void synthesise_all() {
    for (std::uint32_t r = 0; r < size_.rows; ++r)
      std::copy_n(row(unmixed(r, size_.rows)), size_.columns, scratch_row(r));
    synthesise(Rows{scratch_.data(), size_.rows, size_.columns, size_.columns});
    for (std::uint32_t r = 0; r < size_.rows; ++r) {
      for (std::uint32_t c = 0; c < size_.columns; ++c) row(r)[c] = scratch_row(r)[unmixed(c, size_.columns)];
      synthesise(Numbers{row(r), size_.columns});
    }
  }

 private:
  double* row(std::uint32_t r) { return image_.data() + std::size_t{r} * stride_; }
  double* scratch_row(std::uint32_t r) { return scratch_.data() + std::size_t{r} * size_.columns; }

  std::vector<double>& image_;
  std::uint32_t stride_;
  Size size_;
  std::vector<double> scratch_;
};

std::vector<Size> sizes_of_levels(Size size, std::uint32_t levels) {
  std::vector<Size> sizes;
  for (std::uint32_t level = 0; level < levels; ++level) {
    sizes.push_back(size);
    size = {(size.columns + 1) / 2, (size.rows + 1) / 2};
  }
  return sizes;
}

// Norms of the two functions of each level on a line: [level][high].
using LineNorms = std::array<std::array<double, 2>, kMostLevels + 1>;

LineNorms line_norms() {
  LineNorms norms{};
  norms[0] = {1, 1};
  for (std::uint32_t level = 1; level <= kMostLevels; ++level)
    for (const bool high : {false, true}) {
      std::uint32_t length = 16;  // of the coarsest low-pass; long enough that no end is felt
      std::vector<double> line(length);
      line[8] = 1;
      for (std::uint32_t l = level; l > 0; --l) {
        std::vector<double> mixed(2 * line.size());
        const bool is_detail = high && l == level;
        for (std::size_t i = 0; i < line.size(); ++i) mixed[2 * i + (is_detail ? 1 : 0)] = line[i];
        synthesise(Numbers{mixed.data(), static_cast<std::uint32_t>(mixed.size())});
        line = std::move(mixed);
      }
      double sum = 0;
      for (const double x : line) sum += x * x;
      norms[level][high] = std::sqrt(sum);
    }
  return norms;
}

}  // namespace

void rectangular_analysis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                          std::vector<double>& samples) {
  assert(samples.size() == std::size_t{columns} * rows);
  for (const Size& size : sizes_of_levels({columns, rows}, levels)) Level(samples, columns, size).analyse_all();
}

void rectangular_synthesis(std::uint32_t columns, std::uint32_t rows, std::uint32_t levels,
                           std::vector<double>& coefficients) {
  assert(coefficients.size() == std::size_t{columns} * rows);
  std::vector<Size> sizes = sizes_of_levels({columns, rows}, levels);
  std::reverse(sizes.begin(), sizes.end());
  for (const Size& size : sizes) Level(coefficients, columns, size).synthesise_all();
}

double synthesis_norm(const Band& band) {
  static const LineNorms norms = line_norms();
  const std::array<double, 2>& level = norms[std::min(band.level, kMostLevels)];
  return level[band.kind & 1] * level[band.kind >> 1];
}

}  // namespace emap
