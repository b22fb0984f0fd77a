#pragma once

// The set that speed is measured on.

#include "libthin/analysis/synthetic_innovations.h"

namespace thin::test {

inline ObservationSet synthetic_innovations(std::size_t count, std::uint64_t seed = 1) {
  return orbit_innovations(count, seed);
}

}  // namespace thin::test
