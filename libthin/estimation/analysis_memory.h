#pragma once

// What a LocalAnalysis will take, before it is begun.

#include <cstdint>
#include <span>

#include "libthin/estimation/background_covariance.h"
#include "libthin/estimation/places.h"
#include "libthin/foundation/result.h"

namespace thin {

// How many observations are within reach of one of these, on average over a sample.
double observations_within_reach(const Places& observations, std::span<const std::uint32_t> points,
                                 const BackgroundCovariance& covariance);

// Error: configuration, where LocalAnalysis would take more than `memory_bytes`, with the remedy.
Result<void> expect_analysis_to_fit(const Places& observations, std::span<const std::uint32_t> evaluation_points,
                                    const BackgroundCovariance& covariance, std::size_t retain_count,
                                    std::uint64_t memory_bytes);

}  // namespace thin
