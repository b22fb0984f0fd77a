#pragma once

// Quantised wavelet coefficients, band by band from coarse to fine: is it zero, its sign, how large is it. Each
// decision is mixed from several contexts: neighbours, the coarser coefficient in the same place, the bands of the same
// level coded before (after EBCOT and ECECOW: D. Taubman, 2000; X. Wu, 1997).

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

  SimpleBits band_is_empty_, escape_;
  ContextMixer zero_, sign_, larger_;
};

}  // namespace emap
