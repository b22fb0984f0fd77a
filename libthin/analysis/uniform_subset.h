#pragma once

// Subsets that know nothing of the values: what adaptive thinning has to beat.

#include <cstdint>
#include <span>
#include <vector>

#include "libthin/observations/observation_set.h"

namespace thin {

// Farthest-point sampling (Gonzalez 1985): from the first observation on, always the one farthest from all retained;
// ties go to the smaller index. As even as a subset can be made cheaply: the least separation is within a factor of two
// of the best. O(n count). Indices, ascending.
std::vector<std::uint32_t> farthest_point_subset(std::span<const Vector3> positions_km, std::size_t count);

// `count` of n, all subsets alike likely; the same for the same seed. Indices, ascending.
std::vector<std::uint32_t> random_subset(std::size_t n, std::size_t count, std::uint64_t seed);

// 0 .. n - 1 in an order of the seed, the same with any standard library.
std::vector<std::uint32_t> random_order(std::size_t n, std::uint64_t seed);

}  // namespace thin
