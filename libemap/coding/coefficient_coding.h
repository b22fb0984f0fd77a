#pragma once

// Quantised wavelet coefficients, band by band from coarse to fine: is it zero, its sign, how many bits has its
// magnitude, and which. Each decision is mixed from several contexts: the magnitude that is expected from neighbours,
// the coarser coefficient in the same place and the bands of the same level coded before (after ECECOW: X. Wu, 1997),
// patterns of these, and how much of the mask the coefficient sees.

#include <array>
#include <cstdint>

#include "libemap/coding/context_mixer.h"
#include "libemap/coding/quantisation.h"

namespace emap {

// One for all the maps of a stream.
class CoefficientCoding {
 public:
  CoefficientCoding();

  // Writes map.values, or reads them into it (all 0 before). A reader whose stream is exhausted stops.
  template <class Coder>
  void code(Coder& coder, QuantisedMap& map);

 private:
  template <class Coder>
  class Run;

  // Mean magnitude so far in bands of one kind and level, in 1/256.
  struct RunningMean {
    std::int64_t value = 0;
    std::int64_t count = 0;
  };

  SimpleBits band_is_empty_, second_bit_;
  ContextMixer zero_, sign_, longer_, first_bit_;
  std::array<std::array<RunningMean, 8>, 4> means_{};  // by kind, level
};

}  // namespace emap
