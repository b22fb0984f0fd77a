#include "libemap/coding/mask_coding.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace emap {
namespace {

enum Block : std::uint8_t { kEmpty, kFull, kMixed };

constexpr std::uint32_t kMargin = 4;  // more than the farthest sample that a context looks at
constexpr std::array<std::uint32_t, 4> kSampleContexts = {1U << 10, 1U << 16, 81U << 6, 9U << 10};

// The blocks of a map with one empty block all around.
class Blocks {
 public:
  Blocks(std::uint32_t columns, std::uint32_t rows)
      : columns_((columns + kMaskBlock - 1) / kMaskBlock),
        rows_((rows + kMaskBlock - 1) / kMaskBlock),
        states_((columns_ + 2) * (rows_ + 2), kEmpty) {}

  std::uint32_t columns() const { return columns_; }
  std::uint32_t rows() const { return rows_; }
  // Indices begin at -1, as unsigned numbers do.
  std::uint8_t& at(std::uint32_t row, std::uint32_t column) { return states_[(row + 1) * (columns_ + 2) + column + 1]; }

 private:
  std::uint32_t columns_, rows_;
  std::vector<std::uint8_t> states_;
};

Block state_of_block(const std::vector<std::uint8_t>& mask, std::uint32_t columns, std::uint32_t rows,
                     std::uint32_t block_row, std::uint32_t block_column) {
  bool any = false, all = true;
  for (std::uint32_t r = block_row * kMaskBlock; r < std::min(rows, (block_row + 1) * kMaskBlock); ++r)
    for (std::uint32_t c = block_column * kMaskBlock; c < std::min(columns, (block_column + 1) * kMaskBlock); ++c)
      (mask[std::size_t{r} * columns + c] ? any : all) = mask[std::size_t{r} * columns + c] != 0;
  return !any ? kEmpty : all ? kFull : kMixed;
}

// How far off the next uniform block is, and what is in it: 0 for a mixed one, else 1 + 2 * (distance class) + full.
std::uint32_t outlook(Block state, std::uint32_t distance) {
  if (state == kMixed) return 0;
  const std::uint32_t distance_class = distance < 2 ? distance : distance < 4 ? 2 : 3;
  return 1 + 2 * distance_class + (state == kFull ? 1 : 0);
}

// A padded copy of the mask as far as it is known.
struct KnownSamples {
  std::uint32_t stride;
  std::vector<std::uint8_t> samples;

  KnownSamples(std::uint32_t columns, std::uint32_t rows)
      : stride(columns + 2 * kMargin), samples(std::size_t{stride} * (rows + kMargin)) {}
  std::uint8_t* row(std::uint32_t r) { return samples.data() + std::size_t{stride} * (r + kMargin) + kMargin; }
};

// Bits of the samples from..to of a row.
std::uint32_t run(const std::uint8_t* samples, int from, int to) {
  std::uint32_t bits = 0;
  for (int i = from; i <= to; ++i) bits = bits << 1 | samples[i];
  return bits;
}

std::array<std::uint32_t, 4> sample_contexts(const std::uint8_t* here, std::uint32_t stride, std::uint32_t right,
                                             std::uint32_t below) {
  const std::uint8_t* above = here - stride;
  const std::uint8_t* above2 = above - stride;
  const std::uint8_t* above3 = above2 - stride;
  const std::uint32_t left4 = run(here, -4, -1);
  const std::uint32_t above7 = run(above, -3, 3);
  const std::uint32_t above5 = (above7 >> 1) & 31;
  const std::uint32_t second5 = run(above2, -2, 2);
  const std::uint32_t second3 = (second5 >> 1) & 7;
  const std::uint32_t medium = (left4 & 3) | above5 << 2 | second3 << 7;
  const std::uint32_t large = left4 | above7 << 4 | second5 << 11;
  const std::uint32_t small = (left4 & 3) | ((above5 >> 1) & 7) << 2 | (second5 >> 2 & 1) << 5;
  const std::uint32_t thirds = (right == 0 ? 0 : 1 + (right - 1) % 2) * 3 + (below == 0 ? 0 : 1 + (below - 1) % 2);
  const std::uint32_t far = medium ^ (above3[0] << 9);
  return {far, large, (right * 9 + below) << 6 | small, thirds << 10 | medium};
}

}  // namespace

MaskCoding::MaskCoding() : block_is_mixed_(81), block_is_full_(81), sample_(kSampleContexts, 9) {}

template <class Coder>
void MaskCoding::code(Coder& coder, std::uint32_t columns, std::uint32_t rows, std::vector<std::uint8_t>& mask) {
  assert(mask.size() == std::size_t{columns} * rows);
  if (mask.empty()) return;
  Blocks blocks(columns, rows);
  KnownSamples known(columns, rows);

  for (std::uint32_t r = 0; r < blocks.rows(); ++r)
    for (std::uint32_t c = 0; c < blocks.columns(); ++c) {
      const Block given = state_of_block(mask, columns, rows, r, c);
      const std::uint32_t context =
          ((blocks.at(r, c - 1) * 3U + blocks.at(r - 1, c - 1)) * 3U + blocks.at(r - 1, c)) * 3U +
          blocks.at(r - 1, c + 1);
      Block state = kMixed;
      if (!block_is_mixed_.code(coder, given == kMixed, context))
        state = block_is_full_.code(coder, given == kFull, context) ? kFull : kEmpty;
      blocks.at(r, c) = state;
      if (state != kFull) continue;
      for (std::uint32_t y = r * kMaskBlock; y < std::min(rows, (r + 1) * kMaskBlock); ++y)
        std::fill_n(known.row(y) + c * kMaskBlock, std::min(kMaskBlock, columns - c * kMaskBlock), std::uint8_t{1});
    }

  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t c = 0; c < blocks.columns(); ++c) {
      const std::uint32_t block_row = y / kMaskBlock;
      if (blocks.at(block_row, c) != kMixed) continue;
      const auto right = static_cast<Block>(blocks.at(block_row, c + 1));
      const auto below = static_cast<Block>(blocks.at(block_row + 1, c));
      const std::uint32_t below_outlook = outlook(below, kMaskBlock - 1 - y % kMaskBlock);
      for (std::uint32_t x = c * kMaskBlock; x < std::min(columns, (c + 1) * kMaskBlock); ++x) {
        std::uint8_t* here = known.row(y) + x;
        const std::uint32_t right_outlook = outlook(right, kMaskBlock - 1 - x % kMaskBlock);
        const auto contexts = sample_contexts(here, known.stride, right_outlook, below_outlook);
        *here = sample_.code(coder, mask[std::size_t{y} * columns + x] != 0, contexts, contexts[3] >> 10);
      }
    }

  for (std::uint32_t y = 0; y < rows; ++y) std::copy_n(known.row(y), columns, mask.begin() + std::size_t{y} * columns);
}

template void MaskCoding::code(RangeEncoder&, std::uint32_t, std::uint32_t, std::vector<std::uint8_t>&);
template void MaskCoding::code(RangeDecoder&, std::uint32_t, std::uint32_t, std::vector<std::uint8_t>&);
template void MaskCoding::code(BitCounter&, std::uint32_t, std::uint32_t, std::vector<std::uint8_t>&);

}  // namespace emap
