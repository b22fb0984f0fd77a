#pragma once

// Embedded bit planes of the coefficients of one map, by splitting and shrinking sets of them (J. E. Fowler,
// "Shape-adaptive coding using binary set splitting with k-d trees", 2004; thesis, 4.2). Each plane takes two passes:
// significance tests sets, halves those that hold a coefficient above the plane and shrinks the halves to what is
// supported; refinement adds one bit to each coefficient found before. The code may end behind any pass.

#include <cstdint>
#include <functional>
#include <vector>

#include "libemap/coding/context_mixer.h"
#include "libemap/coding/shape_adaptive_wavelet.h"

namespace emap {

constexpr std::uint32_t kBitPlanes = 29;

// Magnitudes are in units of the quantiser's finest step, below 2^kBitPlanes.
struct CoefficientPlanes {
  std::uint32_t columns = 0, rows = 0;
  std::vector<Band> bands;
  std::vector<std::uint8_t> support;      // 1 where there is a coefficient
  std::vector<std::uint32_t> magnitudes;  // of the writer
  std::vector<std::uint8_t> negative;     // of the writer: 1 for coefficients below zero
  std::vector<std::int32_t> halves = {};  // what a reader knows: signed, in halves of the finest step

  CoefficientPlanes(std::uint32_t columns, std::uint32_t rows, std::vector<Band> bands,
                    std::vector<std::uint8_t> support);
};

class SetSplittingCoding {
 public:
  SetSplittingCoding();

  // Called when the reader's value of the coefficient at `index` changes, in halves of the finest step, and behind a
  // pass.
  struct Observer {
    std::function<void(std::uint32_t index, std::int32_t before, std::int32_t after)> changed;
    std::function<void()> pass_done;
  };

  // Codes `passes` passes from plane `top_plane` downwards: significance, refinement, significance, ... and brings
  // planes.halves up to date. REQUIRES: top_plane < kBitPlanes, passes <= 2 * (top_plane + 1)
  template <class Coder>
  void code(Coder& coder, CoefficientPlanes& planes, std::uint32_t top_plane, std::uint32_t passes,
            const Observer* observer = nullptr);

 private:
  template <class Coder>
  class Run;

  ContextMixer significance_;
  SimpleBits refinement_;
};

}  // namespace emap
