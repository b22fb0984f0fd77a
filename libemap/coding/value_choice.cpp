#include "libemap/coding/value_choice.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <limits>

#include "libemap/coding/coefficient_support.h"

namespace emap {
namespace {

constexpr double kBitPrice = 0.1;  // squared steps
constexpr std::int32_t kLargest = (1 << kValueBits) - 1;

using Line = Eigen::Map<Eigen::ArrayXf>;
using ConstantLine = Eigen::Map<const Eigen::ArrayXf>;

ConstantLine array_of(const LineFunction& function) {
  return {function.values.data(), static_cast<Eigen::Index>(function.values.size())};
}

// Synthesised in a window of whole cells of the level around it, beyond which it is zero.
LineFunction line_function(std::uint32_t length, std::uint32_t level, bool high, std::uint32_t index) {
  constexpr std::uint32_t kReach = 8;  // cells; invariant: more than the function's half width
  const std::uint32_t first_cell = index < kReach ? 0 : index - kReach;
  const std::uint64_t cell = std::uint64_t{1} << level;
  const auto end = static_cast<std::uint32_t>(std::min<std::uint64_t>(length, (index + kReach + 1) * cell));
  const auto begin = static_cast<std::uint32_t>(first_cell * cell);
  const std::uint32_t count = end - begin;
  const auto low_count = static_cast<std::uint32_t>((count + cell - 1) / cell);
  std::vector<double> line(count);
  line[(high ? low_count : 0) + index - first_cell] = 1;
  rectangular_synthesis(count, 1, level, line);
  std::uint32_t from = 0, to = count;
  while (from < to && line[from] == 0) ++from;
  while (to > from && line[to - 1] == 0) --to;
  return {begin + from, std::vector<float>(line.begin() + from, line.begin() + to)};
}

}  // namespace

MagnitudeCosts::MagnitudeCosts() {
  for (auto& level : of_length_)
    for (auto& surroundings : level)
      for (std::uint32_t length = 0; length < kLengths; ++length)
        surroundings[length] = length < 2 ? 0.5 : std::ldexp(0.5, -static_cast<int>(length));
}

void MagnitudeCosts::count(const QuantisedMap& map) {
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    const Band& band = map.bands[b];
    if (band.kind == 0) continue;
    auto& counts = of_length_[std::min(band.level, kLevels - 1)];
    for (std::uint32_t r = 0; r < band.rows; ++r)
      for (std::uint32_t c = 0; c < band.columns; ++c) {
        const std::size_t i = map.index(band.row + r, band.column + c);
        if (!map.support[i]) continue;
        ++counts[surroundings(map, b, r, c)][std::bit_width(static_cast<std::uint32_t>(std::abs(map.values[i])))];
      }
  }
}

void MagnitudeCosts::finish() {
  for (auto& level : of_length_)
    for (auto& surroundings : level) {
      double sum = 0;
      for (const double count : surroundings) sum += count;
      // A sign, and the bits below the highest.
      for (std::uint32_t length = 0; length < kLengths; ++length)
        surroundings[length] = std::log2(sum / surroundings[length]) + length;
    }
}

double MagnitudeCosts::bits(std::uint32_t level, std::uint32_t surroundings, std::uint32_t magnitude) const {
  return of_length_[std::min(level, kLevels - 1)][surroundings][std::bit_width(magnitude)];
}

std::uint32_t MagnitudeCosts::surroundings(const QuantisedMap& map, std::size_t band_index, std::uint32_t row,
                                           std::uint32_t column) {
  const Band& band = map.bands[band_index];
  const auto at = [&](std::uint32_t r, std::uint32_t c) -> double {  // -1 wraps to beyond the band
    return r < band.rows && c < band.columns ? std::abs(map.values[map.index(band.row + r, band.column + c)]) : 0;
  };
  double sum = 2 * (at(row, column - 1) + at(row, column + 1) + at(row - 1, column) + at(row + 1, column)) +
               at(row - 1, column - 1) + at(row - 1, column + 1) + at(row + 1, column - 1) + at(row + 1, column + 1);
  if (band_index >= 4 && map.bands[band_index - 3].kind == band.kind) {
    const Band& parent = map.bands[band_index - 3];
    const std::uint32_t r = std::min(row / 2, parent.rows - 1), c = std::min(column / 2, parent.columns - 1);
    sum += 0.5 * std::abs(map.values[map.index(parent.row + r, parent.column + c)]);
  }
  if (sum == 0) return 0;
  return std::min(kClasses - 1, 1 + static_cast<std::uint32_t>(2 * std::log2(sum + 1)));
}

ValueChoice::ValueChoice(const ElevationPatch& patch, const QuantisedMap& layout)
    : patch_(patch), mask_(patch.mask.begin(), patch.mask.end()) {
  for (const Band& band : layout.bands) {
    of_columns_.resize(std::max<std::size_t>(of_columns_.size(), band.level + 1));
    of_rows_.resize(of_columns_.size());
    const auto fill = [&](BandFunctions& functions, std::uint32_t length, std::uint32_t high, std::uint32_t count) {
      if (!functions[high].empty()) return;
      for (std::uint32_t i = 0; i < count; ++i)
        functions[high].push_back(line_function(length, band.level, high != 0, i));
    };
    fill(of_columns_[band.level], patch.columns, band.kind & 1, band.columns);
    fill(of_rows_[band.level], patch.rows, band.kind >> 1, band.rows);
  }
}

// Of one map, with the residual of its supported samples.
class ValueChoice::Sweep {
 public:
  Sweep(const ValueChoice& choice, const MagnitudeCosts& costs, double step, QuantisedMap& map)
      : choice_(choice), costs_(costs), step_(step), map_(map) {
    std::vector<double> image(map.values.size());
    for (const Band& band : map.bands)
      for_band(band, map.columns,
               [&](std::size_t i) { image[i] = step_of_band(band, step) * reconstructed(map.values[i], band.kind); });
    rectangular_synthesis(map.columns, map.rows, rectangular_levels(map.columns, map.rows), image);
    residual_.resize(image.size());
    for (std::size_t i = 0; i < image.size(); ++i)
      if (choice.patch_.mask[i]) residual_[i] = static_cast<float>(choice.patch_.elevation[i] - image[i]);
    shown_ = residual_in_line_ = change_ = Eigen::ArrayXf::Zero(map.columns);
  }

  void run() {
    for (std::size_t b = 0; b < map_.bands.size(); ++b)
      for (std::uint32_t r = 0; r < map_.bands[b].rows; ++r) choose_row(b, r);
  }

 private:
  ConstantLine row_of(const std::vector<float>& image, std::size_t row) const {
    return {image.data() + row * map_.columns, static_cast<Eigen::Index>(map_.columns)};
  }

  // A row of a band's functions is one function of the rows times functions of the columns: with the residual summed up
  // over the rows once, a coefficient is a matter of a line.
  void choose_row(std::size_t b, std::uint32_t r) {
    const Band& band = map_.bands[b];
    const std::size_t first = map_.index(band.row + r, band.column);
    const std::uint8_t* support = map_.support.data() + first;
    if (std::find(support, support + band.columns, 1) == support + band.columns) return;
    const LineFunction& down = choice_.of_rows_[band.level][band.kind >> 1][r];
    shown_.setZero();
    residual_in_line_.setZero();
    for (std::size_t i = 0; i < down.values.size(); ++i) {
      const float weight = down.values[i];
      residual_in_line_ += weight * row_of(residual_, down.begin + i);
      shown_ += weight * weight * row_of(choice_.mask_, down.begin + i);
    }
    change_.setZero();
    bool changed = false;
    for (std::uint32_t c = 0; c < band.columns; ++c)
      if (support[c]) changed |= choose(b, r, c);
    if (!changed) return;
    for (std::size_t i = 0; i < down.values.size(); ++i)
      Line(residual_.data() + (down.begin + i) * map_.columns, map_.columns) -=
          down.values[i] * change_ * row_of(choice_.mask_, down.begin + i);
  }

  bool choose(std::size_t b, std::uint32_t r, std::uint32_t c) {
    const Band& band = map_.bands[b];
    std::int32_t& value = map_.values[map_.index(band.row + r, band.column + c)];
    const LineFunction& function = choice_.of_columns_[band.level][band.kind & 1][c];
    const ConstantLine across = array_of(function);
    const auto begin = static_cast<Eigen::Index>(function.begin), length = across.size();
    const auto shown = shown_.segment(begin, length);
    const double norm = synthesis_norm(band);
    const double seen = (across.square() * shown).sum();  // the part of norm^2 that the mask shows
    if (seen < 1e-6 * norm * norm) return false;
    const double band_step = step_of_band(band, step_);
    const double now = reconstructed(value, band.kind);
    const double best = now + (across * residual_in_line_.segment(begin, length)).sum() / seen / band_step;
    const std::int32_t chosen = cheapest(b, r, c, best, value, seen / (norm * norm));
    if (chosen == value) return false;
    const auto change = static_cast<float>((reconstructed(chosen, band.kind) - now) * band_step);
    residual_in_line_.segment(begin, length) -= change * across * shown;
    change_.segment(begin, length) += change * across;
    value = chosen;
    return true;
  }

  // weight: of a squared step of this coefficient, against one that is seen whole.
  std::int32_t cheapest(std::size_t b, std::uint32_t r, std::uint32_t c, double best, std::int32_t now,
                        double weight) const {
    const Band& band = map_.bands[b];
    const auto below = static_cast<std::int32_t>(std::min<double>(std::abs(best), kLargest - 1));
    const std::uint32_t surroundings = band.kind == 0 ? 0 : MagnitudeCosts::surroundings(map_, b, r, c);
    std::int32_t cheapest = now;
    double least = std::numeric_limits<double>::infinity();
    for (const std::int32_t magnitude : {0, below, below + 1, std::abs(now)}) {
      const std::int32_t value = best < 0 ? -magnitude : magnitude;
      const double error = reconstructed(value, band.kind) - best;
      const double bits = band.kind == 0 ? low_pass_bits(band, r, c, value)
                                         : costs_.bits(band.level, surroundings, static_cast<std::uint32_t>(magnitude));
      const double cost = error * error * weight + kBitPrice * bits;
      if (cost >= least) continue;
      least = cost;
      cheapest = value;
    }
    return cheapest;
  }

  // The coarsest low-pass is coded as differences from its neighbours.
  double low_pass_bits(const Band& band, std::uint32_t r, std::uint32_t c, std::int32_t value) const {
    const double west = c > 0 ? map_.values[map_.index(band.row + r, band.column + c - 1)] : 0;
    const double north = r > 0 ? map_.values[map_.index(band.row + r - 1, band.column + c)] : west;
    return 2 * std::log2(1 + std::abs(value - (c > 0 ? (west + north) / 2 : north)));
  }

  const ValueChoice& choice_;
  const MagnitudeCosts& costs_;
  double step_;
  QuantisedMap& map_;
  std::vector<float> residual_;  // 0 outside the mask
  // Of the row of coefficients in hand, for each column of samples: sums over the rows of its functions.
  Eigen::ArrayXf residual_in_line_, shown_, change_;
};

void ValueChoice::sweep(const MagnitudeCosts& costs, double step, QuantisedMap& map) const {
  assert(map.values.size() == mask_.size());
  Sweep(*this, costs, step, map).run();
}

}  // namespace emap
