#include "libthin/analysis/uniform_subset.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace thin {
namespace {

double squared_distance(const Vector3& a, const Vector3& b) {
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

}  // namespace

std::vector<std::uint32_t> farthest_point_subset(std::span<const Vector3> positions_km, std::size_t count) {
  std::vector<std::uint32_t> retained;
  std::vector<double> nearest(positions_km.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (retained.size() < std::min(count, positions_km.size())) {
    retained.push_back(static_cast<std::uint32_t>(next));
    const Vector3 added = positions_km[next];
    nearest[next] = -1;
    next = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      if (nearest[i] >= 0) nearest[i] = std::min(nearest[i], squared_distance(positions_km[i], added));
      if (nearest[i] > nearest[next]) next = i;
    }
  }
  std::sort(retained.begin(), retained.end());
  return retained;
}

std::vector<std::uint32_t> random_order(std::size_t n, std::uint64_t seed) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937_64 random(seed);
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

std::vector<std::uint32_t> random_subset(std::size_t n, std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> order = random_order(n, seed);
  order.resize(std::min(count, n));
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace thin
