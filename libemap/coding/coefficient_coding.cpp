#include "libemap/coding/coefficient_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "libemap/coding/coefficient_support.h"

namespace emap {
namespace {

constexpr std::uint32_t kLevels = 8;
constexpr std::int32_t kLargestValue = 1 << (kValueBits + 2);  // beyond what any writer writes
constexpr std::uint32_t kLongest = kValueBits + 1;  // bits of a magnitude: differences have one more than values
constexpr std::uint32_t kExpected = 64;             // classes of the magnitude that is expected
constexpr std::uint32_t kVisible = kVisibilityClasses;
constexpr std::array<std::uint32_t, 5> kZeroContexts = {6 * 8 * 4, 144 * 4, 16 * kLevels, kVisible * 3 * 4 * kLevels,
                                                        kExpected* kVisible};
constexpr std::array<std::uint32_t, 5> kLongerContexts = {7 * kExpected * kVisible, kExpected * 4,
                                                          kLongest * 4 * kLevels, kLongest * 7 * 7, kLongest * 64};
constexpr std::array<std::uint32_t, 3> kFirstBitContexts = {(kLongest + 1) * kExpected, (kLongest + 1) * 4 * kLevels,
                                                            (kLongest + 1) * kVisible};
constexpr std::array<std::uint32_t, 3> kSignContexts = {9 * 4, 27 * 4, 81};

// The expected magnitude, in 1/256: weights of running mean (1/256), W, N, NW, NE, WW, NN, parent, sisters, by kind.
// Fitted to several models; the least mean of log E + |v| / E.
struct ExpectationWeights {
  std::uint32_t mean, west, north, north_west, north_east, west2, north2, parent, sisters;
};
constexpr std::array<ExpectationWeights, 4> kExpectation = {{{256, 0, 0, 0, 0, 0, 0, 0, 0},
                                                             {6, 73, 97, 24, 31, 2, 13, 1, 0},
                                                             {4, 99, 44, 21, 28, 20, 0, 1, 7},
                                                             {1, 57, 50, 23, 29, 0, 0, 1, 3}}};
constexpr std::int64_t kFirstMean = 64 * 256;
constexpr std::int64_t kMeanMemory = 100;

bool cut_short(const RangeDecoder& coder) {
  return coder.exhausted();
}
template <class Coder>
bool cut_short(const Coder&) {
  return false;
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

// Two to an octave.
std::uint32_t expected_class(std::uint64_t expected) {
  const auto x = static_cast<std::uint32_t>(std::min<std::uint64_t>(expected, (1U << 30) - 1));
  if (x < 2) return x;
  const auto length = static_cast<std::uint32_t>(std::bit_width(x));
  return 2 * (length - 1) + (x >> (length - 2) & 1);
}

std::uint32_t length_class(std::uint32_t magnitude, std::uint32_t most) {
  return std::min(static_cast<std::uint32_t>(std::bit_width(magnitude)), most);
}

// 0 for 0, 1 for positive, 2 for negative
std::uint32_t sign_class(std::int32_t value) {
  return value == 0 ? 0 : value > 0 ? 1 : 2;
}

// What is known around a coefficient. Magnitudes; 0 outside the band.
struct Neighbourhood {
  std::uint32_t west = 0, west2 = 0, north = 0, north2 = 0, north_west = 0, north_east = 0;
  std::uint32_t parent = 0;   // twice the coarser coefficient of the same kind in this place, and those beside it
  std::uint32_t sisters = 0;  // twice those of the level's bands coded before in this place, and those beside them
};

}  // namespace

CoefficientCoding::CoefficientCoding()
    : band_is_empty_(4 * kLevels * 2),
      second_bit_((kLongest + 1) * 2),
      zero_(kZeroContexts, kVisible * 3),
      sign_(kSignContexts, 4),
      longer_(kLongerContexts, kLongest * kVisible),
      first_bit_(kFirstBitContexts, kLongest + 1) {}

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
    RunningMean& mean = begun_mean(band);
    for (std::uint32_t r = band.row; r < band.row + band.rows && !cut_short(coder_); ++r)
      for (std::uint32_t c = band.column; c < band.column + band.columns; ++c) {
        if (!map_.support[index(r, c)]) continue;
        // The coarsest low-pass band is predicted from its neighbours; what is coded is the difference.
        const std::int32_t prediction = band.kind == 0 ? predicted(band, r, c) : 0;
        std::int32_t& value = map_.values[index(r, c)];
        const std::int32_t coded = code_value(value - prediction, band, around(b, r, c), mean, r, c);
        value = std::clamp(prediction + coded, -kLargestValue, kLargestValue);
        magnitudes_[index(r, c)] = static_cast<std::uint32_t>(std::abs(coded));
        mean.count = std::min(mean.count + 1, kMeanMemory);
        mean.value += (std::int64_t{256} * std::abs(coded) - mean.value) / mean.count;
      }
  }

  // Details fall by about four from level to level.
  RunningMean& begun_mean(const Band& band) {
    const std::uint32_t level = level_of(band);
    auto& of_kind = models_.means_[band.kind];
    RunningMean& mean = of_kind[level];
    if (mean.count > 0) return mean;
    mean.count = 1;
    if (band.kind == 0)
      mean.value = kFirstMean;
    else if (level + 1 < kLevels && of_kind[level + 1].count > 0)
      mean.value = of_kind[level + 1].value / 4;
    else
      mean.value = models_.means_[band.kind - 1][level].value;
    return mean;
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
    const bool east = c + 1 < band.column + band.columns;
    Neighbourhood n;
    if (west) n.west = magnitudes_[here - 1];
    if (c > band.column + 1) n.west2 = magnitudes_[here - 2];
    if (north) n.north = magnitudes_[here - stride];
    if (r > band.row + 1) n.north2 = magnitudes_[here - 2 * stride];
    if (north && west) n.north_west = magnitudes_[here - stride - 1];
    if (north && east) n.north_east = magnitudes_[here - stride + 1];
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

  static std::uint32_t expected_around(const Neighbourhood& n, const RunningMean& mean, std::uint32_t kind) {
    const ExpectationWeights& weights = kExpectation[kind];
    const auto term = [](std::uint32_t weight, std::uint64_t magnitude) { return weight * magnitude; };
    return expected_class((term(weights.mean, static_cast<std::uint64_t>(mean.value)) >> 8) +
                          term(weights.west, n.west) + term(weights.north, n.north) +
                          term(weights.north_west, n.north_west) + term(weights.north_east, n.north_east) +
                          term(weights.west2, n.west2) + term(weights.north2, n.north2) +
                          term(weights.parent, n.parent) + term(weights.sisters, n.sisters));
  }

  std::int32_t code_value(std::int32_t given, const Band& band, const Neighbourhood& n, const RunningMean& mean,
                          std::uint32_t r, std::uint32_t c) {
    const std::uint32_t near = 2 * (n.west + n.north) + n.north_west + n.north_east;
    const std::uint32_t all = 2 * near + n.west2 + n.north2 + 2 * n.parent + n.sisters;
    const std::uint32_t kind = band.kind, level = level_of(band);
    const std::uint32_t pattern =
        (((std::min(n.west, 2U) * 3 + std::min(n.north, 2U)) * 2 + std::min(n.north_west, 1U)) * 2 +
         std::min(n.north_east, 1U)) *
            4 +
        std::min(n.west2, 1U) * 2 + std::min(n.north2, 1U);
    const std::uint32_t visible = map_.visibility[index(r, c)];
    const std::uint32_t visible_near = visible * 3 + std::min(near, 2U);
    const std::uint32_t expected = expected_around(n, mean, kind);
    const std::array<std::uint32_t, 5> zero_contexts = {(six_classes(n.sisters) * 8 + eight_classes(near)) * 4 + kind,
                                                        pattern * 4 + kind, sixteen_classes(all) * kLevels + level,
                                                        (visible_near * 4 + kind) * kLevels + level,
                                                        expected * kVisible + visible};
    if (models_.zero_.code(coder_, given == 0, zero_contexts, visible_near)) return 0;

    const bool negative = code_sign(given < 0, band, r, c);
    const auto magnitude = static_cast<std::int32_t>(
        code_magnitude(static_cast<std::uint32_t>(std::abs(given)), n, {kind * kLevels + level, visible, expected}));
    return negative ? -magnitude : magnitude;
  }

  struct Place {
    std::uint32_t kind_and_level, visible, expected;
  };

  // The number of bits one by one, then the bits below the highest. More bits than are expected are as likely at every
  // scale.
  std::uint32_t code_magnitude(std::uint32_t given, const Neighbourhood& n, const Place& place) {
    const std::uint32_t beside = length_class(n.west, 6) * 7 + length_class(n.north, 6);
    const std::uint32_t coarser = length_class(n.parent, 7) * 8 + length_class(n.sisters, 7);
    const auto wanted = static_cast<std::uint32_t>(std::bit_width(given));
    std::uint32_t length = 1;
    for (; length < kLongest; ++length) {
      const std::uint32_t relative = std::max(place.expected + 2, 2 * length) - 2 * length;
      const std::array<std::uint32_t, 5> contexts = {
          (std::min(length, 6U) * kExpected + relative) * kVisible + place.visible,
          relative * 4 + place.kind_and_level / kLevels, length * 4 * kLevels + place.kind_and_level,
          length * 49 + beside, length * 64 + coarser};
      if (!models_.longer_.code(coder_, wanted > length, contexts, length * kVisible + place.visible)) break;
    }
    if (length == 1) return 1;
    const std::array<std::uint32_t, 3> contexts = {length * kExpected + place.expected,
                                                   length * 4 * kLevels + place.kind_and_level,
                                                   length * kVisible + place.visible};
    const bool first = models_.first_bit_.code(coder_, given >> (length - 2) & 1, contexts, length);
    std::uint32_t magnitude = 2 + first;
    if (length > 2)
      magnitude = 2 * magnitude + models_.second_bit_.code(coder_, given >> (length - 3) & 1, length * 2 + first);
    for (std::uint32_t bit = length - 2; bit-- > 1;)
      magnitude = 2 * magnitude + coder_.code(given >> (bit - 1) & 1, kProbabilityOne / 2);
    return magnitude;
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
