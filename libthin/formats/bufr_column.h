#pragma once

// One element of a BUFR message over all of its subsets.

#include <cstddef>
#include <string>
#include <vector>

#include "libthin/formats/bufr_header.h"
#include "libthin/formats/eccodes_message.h"
#include "libthin/foundation/result.h"

namespace thin {

// Holds what ecCodes gives, and no more: one value where a compressed message says that it is constant.
class BufrColumn {
 public:
  // key: without rank, "latitude". rank: from 1, among the elements of this name in one subset.
  // Error input, where the message lacks it or its subsets have different numbers of them.
  static Result<BufrColumn> read(const EccodesMessage& message, const BufrHeader& header, const std::string& key,
                                 int rank);

  // NaN for missing. REQUIRES: subset < header.subset_count
  double operator[](std::size_t subset) const { return values_[stride_ * subset]; }

 private:
  std::vector<double> values_;
  std::size_t stride_ = 0;
};

}  // namespace thin
