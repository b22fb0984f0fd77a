#pragma once

// Quantised wavelet coefficients, band by band from coarse to fine: is it zero, its sign, how large is it. Each
// decision is mixed from several contexts: neighbours, the coarser coefficient in the same place, the bands of the same
// level coded before (after EBCOT and ECECOW: D. Taubman, 2000; X. Wu, 1997).

#include <cstdint>
#include <vector>

#include "libemap/coding/context_mixer.h"
#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

struct QuantisedMap {
  std::uint32_t columns = 0, rows = 0;
  std::vector<Band> bands;
  std::vector<std::uint8_t> support;  // 1 for the coefficients that are coded
  std::vector<std::int32_t> values;   // 0 outside the support; below 2^kValueBits
};

constexpr std::uint32_t kValueBits = 26;

// One for all the maps of a stream.
class CoefficientCoding {
 public:
  CoefficientCoding();

  // Writes map.values, or reads them into it (all 0 before). A reader whose stream is exhausted stops.
  //
  // wanted: for a writer that leaves the choice of values to the coding, in quantiser steps, for each place. A value
  // becomes a smaller one or 0 where the squared error that this adds is less than the bits that it saves are worth.
  template <class Coder>
  void code(Coder& coder, QuantisedMap& map, const std::vector<double>* wanted = nullptr);

 private:
  template <class Coder>
  class Run;

  SimpleBits band_is_empty_, escape_;
  ContextMixer zero_, sign_, larger_;
};

}  // namespace emap
