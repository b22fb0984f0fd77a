#pragma once

// The masks of elevation maps: where the surface is (thesis, 4.2). First the 8 x 8 blocks, each empty, full or mixed;
// then the samples of the mixed blocks, row by row, from what is known above, to the left and in the blocks all around.

#include <cstdint>
#include <vector>

#include "libemap/coding/context_mixer.h"

namespace emap {

constexpr std::uint32_t kMaskBlock = 8;

// One for all the patches of a stream: what it has learnt from one serves the next.
class MaskCoding {
 public:
  MaskCoding();

  // Writes `mask` (rows x columns, row by row, 0 or 1), or reads it into `mask`, which must have that size.
  template <class Coder>
  void code(Coder& coder, std::uint32_t columns, std::uint32_t rows, std::vector<std::uint8_t>& mask);

 private:
  SimpleBits block_is_mixed_, block_is_full_;
  ContextMixer sample_;
};

}  // namespace emap
