#pragma once

// The probability of a bit, learnt while coding, from several contexts at once: each context keeps an estimate of its
// own, and the estimates are mixed in the logistic domain by weights that are learnt as well (M. Mahoney, "Adaptive
// weighing of context models for lossless data compression", 2005). Integers only, so that every machine decodes alike;
// the arithmetic is part of the format (docs/emap-format.md).

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libemap/coding/range_coder.h"

namespace emap {

// ln(p / (1 - p)) in 1/256 of p in 1/4096, and its inverse in 1/65536; squash clamps its argument to +-2560.
std::int32_t stretch(std::uint32_t probability_12_bits);
std::uint32_t squash(std::int32_t logit);

// Estimate of one context: a frequency whose memory is the last `limit` bits or so.
class AdaptiveBit {
 public:
  std::uint32_t probability_12_bits() const { return state_ >> 20; }
  std::uint32_t probability_16_bits() const;
  void update(bool bit, std::uint32_t limit);

 private:
  std::uint32_t state_ = 1U << 31;  // 22 bits of probability of one, 10 bits of count
};

// A bit with one context, where the contexts are few and the bits are many.
class SimpleBits {
 public:
  explicit SimpleBits(std::size_t context_count) : contexts_(context_count) {}

  template <class Coder>
  bool code(Coder& coder, bool bit, std::size_t context) {
    AdaptiveBit& estimate = contexts_[context];
    bit = coder.code(bit, estimate.probability_16_bits());
    estimate.update(bit, kLimit);
    return bit;
  }

 private:
  static constexpr std::uint32_t kLimit = 160;
  std::vector<AdaptiveBit> contexts_;
};

class ContextMixer {
 public:
  static constexpr std::size_t kMaximumInputs = 10;

  // One table of estimates for each of context_counts; weight_sets: how many vectors of weights there are.
  // REQUIRES: context_counts.size() < kMaximumInputs
  ContextMixer(std::span<const std::uint32_t> context_counts, std::uint32_t weight_sets);

  // contexts: one for each table, each below its count. REQUIRES: weight_set < weight_sets
  template <class Coder>
  bool code(Coder& coder, bool bit, std::span<const std::uint32_t> contexts, std::uint32_t weight_set) {
    const std::uint32_t probability = predict(contexts, weight_set);
    bit = coder.code(bit, probability);
    learn(bit, probability);
    return bit;
  }

  // Of a one in these contexts, in 1/65536, without learning.
  std::uint32_t predict(std::span<const std::uint32_t> contexts, std::uint32_t weight_set);

 private:
  void learn(bool bit, std::uint32_t probability);

  std::vector<std::vector<AdaptiveBit>> tables_;
  std::vector<std::int32_t> weights_;      // in 1/65536; tables_.size() + 1 to a set, the last that of a constant
  std::vector<std::uint32_t> set_counts_;  // bits that a set has seen
  // Of the bit in hand:
  std::array<AdaptiveBit*, kMaximumInputs> estimates_{};
  std::array<std::int32_t, kMaximumInputs> inputs_{};
  std::uint32_t set_ = 0;
};

}  // namespace emap
