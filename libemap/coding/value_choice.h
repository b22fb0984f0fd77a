#pragma once

// Which whole number each coefficient becomes. Rounding would be right for an orthogonal transform of a whole
// rectangle; here functions overlap and the mask hides parts of them. So coefficients are taken one after the other,
// each is set to what lessens squared error of the supported samples + price * bits most while all others stay, and
// what it changes is taken from the residual at once (coordinate descent). Coefficients of which the mask shows little
// become zero, and errors of one are made up for by the next.

#include <array>
#include <cstdint>
#include <vector>

#include "libemap/coding/quantisation.h"
#include "libemap/elevation/elevation_map.h"

namespace emap {

// Bits of magnitudes and signs, from how often each occurs among neighbours of such size.
class MagnitudeCosts {
 public:
  MagnitudeCosts();

  void count(const QuantisedMap& map);
  void finish();  // after all maps; then bits() may be asked

  double bits(std::uint32_t level, std::uint32_t surroundings, std::uint32_t magnitude) const;

  // Class of the magnitudes around a coefficient, on all sides, and of its parent.
  static std::uint32_t surroundings(const QuantisedMap& map, std::size_t band, std::uint32_t row, std::uint32_t column);

 private:
  static constexpr std::uint32_t kLevels = 8, kClasses = 24, kLengths = kValueBits + 1;
  std::array<std::array<std::array<double, kLengths>, kClasses>, kLevels> of_length_{};  // counts, then bits
};

// What one coefficient 1 becomes on a line of samples.
struct LineFunction {
  std::uint32_t begin = 0;
  std::vector<float> values;
};

class ValueChoice {
 public:
  // The patch must outlive this; layout: bands and support.
  ValueChoice(const ElevationPatch& patch, const QuantisedMap& layout);

  // One round through all coefficients, coarse to fine. step: of the stream, model units.
  void sweep(const MagnitudeCosts& costs, double step, QuantisedMap& map) const;

 private:
  class Sweep;
  using BandFunctions = std::array<std::vector<LineFunction>, 2>;  // low-pass, high-pass

  const ElevationPatch& patch_;
  std::vector<float> mask_;
  std::vector<BandFunctions> of_columns_, of_rows_;  // by level
};

}  // namespace emap
