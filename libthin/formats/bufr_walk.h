#pragma once

// One walk over a subset (or all subsets, where they are compressed) of section 4, descriptor by descriptor: which
// fields come, and where. Part of bufr_data.h.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "libthin/formats/bufr_data.h"

namespace thin {

class BufrWalk {
 public:
  struct Input {
    std::span<const std::uint8_t> data;  // section 4 without its first four bytes
    const BufrTables* tables = nullptr;
    bool compressed = false;
    std::uint32_t subset_count = 0;
  };
  explicit BufrWalk(const Input& input) : input_(input), steps_left_(kFreeSteps + 8 * input.data.size()) {}

  // Walks the descriptors from bit `begin` of the data on. May be called once for each subset.
  Result<void> subset(std::span<const int> descriptors, std::size_t begin);

  std::vector<BufrField>& fields() { return fields_; }
  std::size_t end() const { return place_; }  // bits
  // Whether where the fields stand depended on numbers in the data, so that another subset may be built otherwise.
  bool depends_on_data() const { return depends_on_data_; }

 private:
  // Steps that take no bits: replications of operators can multiply to any number of them.
  static constexpr std::size_t kFreeSteps = 1'000'000;
  static constexpr std::size_t kMostFields = 1'000'000;  // of a subset
  static constexpr int kDeepest = 64;                    // sequences and replications within one another

  // What operators have changed. Each subset begins with none.
  struct Operators {
    int added_width = 0;                               // 201
    int added_scale = 0;                               // 202
    unsigned reference_bits = 0;                       // 203: new references are read from the data
    std::vector<unsigned> associated;                  // 204: bits of each field in force
    unsigned local_width = 0;                          // 206, for the next descriptor
    int raised_by = 0;                                 // 207
    unsigned characters = 0;                           // 208
    bool in_quality_block = false;                     // 222 to 225, 232
    std::unordered_map<int, std::int64_t> references;  // that 203 has changed
  };

  Result<void> descriptors(std::span<const int> list, int depth);
  Result<void> replication(std::span<const int> list, std::size_t& place, int depth);
  Result<std::size_t> replication_factor(int descriptor);
  Result<void> operator_descriptor(int descriptor);
  Result<void> element(int descriptor);
  Result<void> described_element(int descriptor, const BufrElement& element);
  Result<void> new_reference(int descriptor);
  Result<void> add(BufrField field);

  Input input_;
  std::vector<BufrField> fields_;
  Operators now_;
  std::size_t begin_ = 0, place_ = 0;
  std::size_t steps_left_;
  bool depends_on_data_ = false;
};

}  // namespace thin
