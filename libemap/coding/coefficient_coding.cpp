#include "libemap/coding/coefficient_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace emap {
namespace {

constexpr std::uint32_t kLevels = 8;
constexpr std::int32_t kLargestValue = 1 << (kValueBits + 2);  // beyond what any writer writes
constexpr std::uint32_t kUnary = 14;  // magnitudes up to this one are counted out, larger ones escape
constexpr std::array<std::uint32_t, 7> kZeroContexts = {12 * 4 * kLevels, 6 * 8 * 4,    6 * 8 * 4,          144 * 4,
                                                        6 * 6 * 4 * 4,    16 * kLevels, 4 * 3 * 4 * kLevels};
constexpr std::array<std::uint32_t, 4> kLargerContexts = {kUnary * 12, kUnary * 6 * 6, kUnary * 4 * kLevels,
                                                          kUnary * 36};
constexpr std::array<std::uint32_t, 3> kSignContexts = {9 * 4, 27 * 4, 81};

bool cut_short(const RangeDecoder& coder) {
  return coder.exhausted();
}
template <class Coder>
bool cut_short(const Coder&) {
  return false;
}

// 0, 1, 2, 3, 4, 5-6, 7-8, 9-12, 13-16, 17-24, 25-40, more
std::uint32_t twelve_classes(std::uint32_t x) {
  static constexpr std::array<std::uint32_t, 11> kLimits = {0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 40};
  return static_cast<std::uint32_t>(std::lower_bound(kLimits.begin(), kLimits.end(), x) - kLimits.begin());
}

std::uint32_t eight_classes(std::uint32_t x) {
  return x < 5 ? x : x < 8 ? 5 : x < 16 ? 6 : 7;
}
std::uint32_t six_classes(std::uint32_t x) {
  return x < 3 ? x : x < 6 ? 3 : x < 12 ? 4 : 5;
}

std::uint32_t sixteen_classes(std::uint32_t x) {
  return x < 8 ? x
               : std::min(
                     7 + static_cast<std::uint32_t>(2 * (std::bit_width(x) - 4) + (x >> (std::bit_width(x) - 2) & 1)),
                     15U);
}

// 0 for 0, 1 for positive, 2 for negative
std::uint32_t sign_class(std::int32_t value) {
  return value == 0 ? 0 : value > 0 ? 1 : 2;
}

// What is known around a coefficient. Magnitudes; 0 outside the band.
struct Neighbourhood {
  std::uint32_t west = 0, west2 = 0, north = 0, north2 = 0, north_west = 0, north_east = 0;
  std::uint32_t parent = 0;      // twice the coarser coefficient of the same kind in this place, and those beside it
  std::uint32_t sisters = 0;     // twice those of the level's bands coded before in this place, and those beside them
  std::uint32_t surrounded = 0;  // how many of the four neighbours are coded, 0 to 3 or more
};

}  // namespace

CoefficientCoding::CoefficientCoding()
    : band_is_empty_(4 * kLevels * 2),
      escape_(2 * 32),
      zero_(kZeroContexts, 12),
      sign_(kSignContexts, 4),
      larger_(kLargerContexts, kUnary) {}

template <class Coder>
class CoefficientCoding::Run {
 public:
  Run(CoefficientCoding& models, Coder& coder, QuantisedMap& map)
      : models_(models), coder_(coder), map_(map), magnitudes_(map.values.size()) {}

  void code() {
    std::array<bool, 4> parent_was_empty{};
    for (std::uint32_t b = 0; b < map_.bands.size() && !cut_short(coder_); ++b) {
      const Band& band = map_.bands[b];
      if (!any_support(band)) continue;
      const std::uint32_t context = (band.kind * kLevels + level_of(band)) * 2 + parent_was_empty[band.kind];
      const bool empty = models_.band_is_empty_.code(coder_, is_empty(band), context);
      parent_was_empty[band.kind] = empty;
      if (!empty) code_band(b);
    }
  }

 private:
  static std::uint32_t level_of(const Band& band) { return std::min(band.level, kLevels) - 1; }

  std::size_t index(std::uint32_t row, std::uint32_t column) const { return std::size_t{row} * map_.columns + column; }

  template <class Values>
  bool any_nonzero(const Band& band, const Values& values) const {
    for (std::uint32_t r = band.row; r < band.row + band.rows; ++r) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(index(r, band.column));
      if (std::any_of(begin, begin + band.columns, [](auto value) { return value != 0; })) return true;
    }
    return false;
  }
  bool any_support(const Band& band) const { return any_nonzero(band, map_.support); }
  bool is_empty(const Band& band) const { return !any_nonzero(band, map_.values); }

  void code_band(std::uint32_t b) {
    const Band& band = map_.bands[b];
    for (std::uint32_t r = band.row; r < band.row + band.rows && !cut_short(coder_); ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        if (!map_.support[index(r, c)]) continue;
        // The coarsest low-pass band is predicted from its neighbours; what is coded is the difference.
        const std::int32_t prediction = band.kind == 0 ? predicted(band, r, c) : 0;
        std::int32_t& value = map_.values[index(r, c)];
        const std::int32_t coded = code_value(value - prediction, band, around(b, r, c), r, c);
        value = std::clamp(prediction + coded, -kLargestValue, kLargestValue);
        magnitudes_[index(r, c)] = static_cast<std::uint32_t>(std::abs(coded));
      }
  }

  std::int32_t predicted(const Band& band, std::uint32_t r, std::uint32_t c) const {
    const bool west = c > band.column, north = r > band.row;
    if (west && north) return (map_.values[index(r, c - 1)] + map_.values[index(r - 1, c)]) / 2;
    return west ? map_.values[index(r, c - 1)] : north ? map_.values[index(r - 1, c)] : 0;
  }

  Neighbourhood around(std::uint32_t b, std::uint32_t r, std::uint32_t c) const {
    const Band& band = map_.bands[b];
    const std::size_t here = index(r, c), stride = map_.columns;
    const bool west = c > band.column, north = r > band.row;
    const bool east = c + 1 < band.column + band.columns, south = r + 1 < band.row + band.rows;
    Neighbourhood n;
    if (west) n.west = magnitudes_[here - 1];
    if (c > band.column + 1) n.west2 = magnitudes_[here - 2];
    if (north) n.north = magnitudes_[here - stride];
    if (r > band.row + 1) n.north2 = magnitudes_[here - 2 * stride];
    if (north && west) n.north_west = magnitudes_[here - stride - 1];
    if (north && east) n.north_east = magnitudes_[here - stride + 1];
    if (west) n.surrounded += map_.support[here - 1];
    if (north) n.surrounded += map_.support[here - stride];
    if (east) n.surrounded += map_.support[here + 1];
    if (south) n.surrounded += map_.support[here + stride];
    n.surrounded = n.surrounded < 2 ? 0 : n.surrounded - 1;
    if (band.kind == 0) return n;
    if (b >= 4 && map_.bands[b - 3].kind == band.kind)
      n.parent = weight_in(map_.bands[b - 3], (r - band.row) / 2, (c - band.column) / 2);
    for (std::uint32_t sister = 1; sister < band.kind && sister <= b; ++sister)
      if (map_.bands[b - sister].level == band.level && map_.bands[b - sister].kind != 0)
        n.sisters += weight_in(map_.bands[b - sister], r - band.row, c - band.column);
    return n;
  }

  // Twice the magnitude at a place of a band that is known whole, and those of its four neighbours.
  std::uint32_t weight_in(const Band& band, std::uint32_t row, std::uint32_t column) const {
    if (row >= band.rows) row = band.rows - 1;
    if (column >= band.columns) column = band.columns - 1;
    const std::size_t here = index(band.row + row, band.column + column);
    std::uint32_t sum = 2 * magnitudes_[here];
    if (row > 0) sum += magnitudes_[here - map_.columns];
    if (row + 1 < band.rows) sum += magnitudes_[here + map_.columns];
    if (column > 0) sum += magnitudes_[here - 1];
    if (column + 1 < band.columns) sum += magnitudes_[here + 1];
    return sum;
  }

  std::int32_t code_value(std::int32_t given, const Band& band, const Neighbourhood& n, std::uint32_t r,
                          std::uint32_t c) {
    const std::uint32_t near = 2 * (n.west + n.north) + n.north_west + n.north_east;
    const std::uint32_t all = 2 * near + n.west2 + n.north2 + 2 * n.parent + n.sisters;
    const std::uint32_t near12 = twelve_classes(near), near8 = eight_classes(near);
    const std::uint32_t parent6 = six_classes(n.parent), sisters6 = six_classes(n.sisters);
    const std::uint32_t level = level_of(band), kind = band.kind;
    const std::uint32_t pattern =
        (((std::min(n.west, 2U) * 3 + std::min(n.north, 2U)) * 2 + std::min(n.north_west, 1U)) * 2 +
         std::min(n.north_east, 1U)) *
            4 +
        std::min(n.west2, 1U) * 2 + std::min(n.north2, 1U);
    const std::array<std::uint32_t, 7> zero_contexts = {
        (near12 * 4 + kind) * kLevels + level,
        (parent6 * 8 + near8) * 4 + kind,
        (sisters6 * 8 + near8) * 4 + kind,
        pattern * 4 + kind,
        ((parent6 * 6 + sisters6) * 4 + std::min(near, 3U)) * 4 + kind,
        sixteen_classes(all) * kLevels + level,
        ((n.surrounded * 3 + std::min(near, 2U)) * 4 + kind) * kLevels + level};
    if (models_.zero_.code(coder_, given == 0, zero_contexts, near12)) return 0;

    const bool negative = code_sign(given < 0, band, r, c);
    const auto wanted = static_cast<std::uint32_t>(std::abs(given));
    const std::array<std::uint32_t, 4> larger_bases = {
        near12, parent6 * 6 + sisters6, kind * kLevels + level,
        std::min(std::max(n.west, n.north), 5U) * 6 + std::min(std::max(n.parent / 2, n.sisters / 2), 5U)};
    std::uint32_t magnitude = 1;
    while (magnitude < kUnary) {
      const std::uint32_t i = magnitude - 1;
      const std::array<std::uint32_t, 4> contexts = {i * 12 + larger_bases[0], i * 36 + larger_bases[1],
                                                     i * 4 * kLevels + larger_bases[2], i * 36 + larger_bases[3]};
      if (!models_.larger_.code(coder_, wanted > magnitude, contexts, i)) break;
      ++magnitude;
    }
    if (magnitude == kUnary) magnitude += code_escape(wanted - kUnary);
    return negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
  }

  bool code_sign(bool given, const Band& band, std::uint32_t r, std::uint32_t c) {
    if (band.kind == 0) return coder_.code(given, kProbabilityOne / 2);
    const std::uint32_t west = c > band.column ? sign_class(map_.values[index(r, c - 1)]) : 0;
    const std::uint32_t north = r > band.row ? sign_class(map_.values[index(r - 1, c)]) : 0;
    const bool both = c > band.column && r > band.row;
    const std::uint32_t north_west = both ? sign_class(map_.values[index(r - 1, c - 1)]) : 0;
    const std::uint32_t west2 = c > band.column + 1 ? sign_class(map_.values[index(r, c - 2)]) : 0;
    const std::uint32_t north2 = r > band.row + 1 ? sign_class(map_.values[index(r - 2, c)]) : 0;
    const std::array<std::uint32_t, 3> contexts = {(west * 3 + north) * 4 + band.kind,
                                                   ((west * 3 + north) * 3 + north_west) * 4 + band.kind,
                                                   ((west * 3 + north) * 3 + west2) * 3 + north2};
    return models_.sign_.code(coder_, given, contexts, band.kind);
  }

  // Exponential Golomb: the number of bits of value + 1, one by one, then the bits below the highest.
  std::uint32_t code_escape(std::uint32_t value) {
    const std::uint32_t wanted = static_cast<std::uint32_t>(std::bit_width(value + 1)) - 1;
    std::uint32_t length = 0;
    while (length < kValueBits && models_.escape_.code(coder_, wanted > length, length)) ++length;
    std::uint32_t number = 1;
    for (std::uint32_t bit = length; bit-- > 0;)
      number = number << 1 | static_cast<std::uint32_t>(coder_.code((value + 1) >> bit & 1, kProbabilityOne / 2));
    return number - 1;
  }

  CoefficientCoding& models_;
  Coder& coder_;
  QuantisedMap& map_;
  std::vector<std::uint32_t> magnitudes_;  // of what was coded
};

template <class Coder>
void CoefficientCoding::code(Coder& coder, QuantisedMap& map) {
  Run<Coder>(*this, coder, map).code();
}

template void CoefficientCoding::code(RangeEncoder&, QuantisedMap&);
template void CoefficientCoding::code(RangeDecoder&, QuantisedMap&);
template void CoefficientCoding::code(BitCounter&, QuantisedMap&);

}  // namespace emap
