#include "libemap/coding/context_mixer.h"

#include <algorithm>
#include <cassert>

namespace emap {
namespace {

constexpr std::int32_t kLargestLogit = 2559;
constexpr std::uint32_t kLeastProbability = 24;  // of 65536
constexpr std::uint32_t kMemoryLimit = 500;
constexpr std::int32_t kConstantInput = 256;

// 65536 / (1 + exp(-x)) at x = -10, -9.5, ... 10.
constexpr std::array<std::uint32_t, 41> kSigmoid = {
    3,     5,     8,     13,    22,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,
    3108,  4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615,
    64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514, 65523, 65528, 65531, 65533};

const std::array<std::int16_t, 4096>& stretch_table() {
  static const std::array<std::int16_t, 4096> table = [] {
    std::array<std::int16_t, 4096> values{};
    std::int32_t logit = -kLargestLogit;
    for (std::uint32_t p = 0; p < 4096; ++p) {
      while (logit < kLargestLogit && squash(logit) < p * 16 + 8) ++logit;
      values[p] = static_cast<std::int16_t>(logit);
    }
    return values;
  }();
  return table;
}

// 65536 / (count + 1.5)
const std::array<std::uint32_t, 1024>& reciprocals() {
  static const std::array<std::uint32_t, 1024> table = [] {
    std::array<std::uint32_t, 1024> values{};
    for (std::uint32_t count = 0; count < 1024; ++count) values[count] = 131072 / (2 * count + 3);
    return values;
  }();
  return table;
}

// Large steps while a set has seen little, small ones later. In 1/4096.
std::int64_t learning_rate(std::uint32_t count) {
  return 16 + 3000 / (count + 40);
}

}  // namespace

std::uint32_t squash(std::int32_t logit) {
  const std::int32_t shifted = std::clamp(logit, -kLargestLogit, kLargestLogit) + 2560;
  const std::uint32_t cell = static_cast<std::uint32_t>(shifted) >> 7;
  const std::uint32_t part = static_cast<std::uint32_t>(shifted) & 127;
  return (kSigmoid[cell] * (128 - part) + kSigmoid[cell + 1] * part + 64) >> 7;
}

std::int32_t stretch(std::uint32_t probability_12_bits) {
  static const std::array<std::int16_t, 4096>& table = stretch_table();
  return table[probability_12_bits];
}

std::uint32_t AdaptiveBit::probability_16_bits() const {
  return std::clamp(state_ >> 16, kLeastProbability, kProbabilityOne - kLeastProbability);
}

void AdaptiveBit::update(bool bit, std::uint32_t limit) {
  static const std::array<std::uint32_t, 1024>& reciprocal = reciprocals();
  const std::uint32_t count = state_ & 1023;
  const std::uint32_t probability = state_ >> 10;
  const std::int64_t error = static_cast<std::int64_t>(bit ? (1U << 22) - 1 : 0) - probability;
  const auto moved = static_cast<std::uint32_t>(probability + (error * reciprocal[count] >> 16));
  state_ = (moved << 10) | (count < limit ? count + 1 : count);
}

ContextMixer::ContextMixer(std::span<const std::uint32_t> context_counts, std::uint32_t weight_sets) {
  assert(context_counts.size() < kMaximumInputs);
  for (const std::uint32_t count : context_counts) tables_.emplace_back(count);
  const auto first_weight = static_cast<std::int32_t>(70000 / std::max<std::size_t>(context_counts.size(), 1));
  for (std::uint32_t set = 0; set < weight_sets; ++set) {
    weights_.insert(weights_.end(), context_counts.size(), first_weight);
    weights_.push_back(0);
  }
  set_counts_.assign(weight_sets, 0);
}

std::uint32_t ContextMixer::predict(std::span<const std::uint32_t> contexts, std::uint32_t weight_set) {
  assert(contexts.size() == tables_.size());
  const std::size_t inputs = tables_.size();
  const std::int32_t* weights = weights_.data() + weight_set * (inputs + 1);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < inputs; ++i) {
    estimates_[i] = &tables_[i][contexts[i]];
    inputs_[i] = stretch(estimates_[i]->probability_12_bits());
    sum += static_cast<std::int64_t>(weights[i]) * inputs_[i];
  }
  inputs_[inputs] = kConstantInput;
  sum += static_cast<std::int64_t>(weights[inputs]) * kConstantInput;
  set_ = weight_set;
  const std::int64_t logit = std::clamp<std::int64_t>(sum >> 16, -kLargestLogit, kLargestLogit);
  return std::clamp(squash(static_cast<std::int32_t>(logit)), kLeastProbability, kProbabilityOne - kLeastProbability);
}

void ContextMixer::learn(bool bit, std::uint32_t probability) {
  const std::size_t inputs = tables_.size();
  std::int32_t* weights = weights_.data() + set_ * (inputs + 1);
  const std::int64_t error = (bit ? std::int64_t{kProbabilityOne} : 0) - probability;
  const std::int64_t step = error * learning_rate(set_counts_[set_]++);
  for (std::size_t i = 0; i <= inputs; ++i) {
    const std::int64_t moved = weights[i] + ((step * inputs_[i] + (1 << 19)) >> 20);
    weights[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(moved, -(1 << 22), 1 << 22));
  }
  for (std::size_t i = 0; i < inputs; ++i) estimates_[i]->update(bit, kMemoryLimit);
}

}  // namespace emap
