#include "libthin/analysis/gaussian_field.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <random>

#include "libthin/foundation/parallel.h"

namespace thin {

std::vector<double> normal_numbers(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&random] { return static_cast<double>(random() >> 11) * 0x1.0p-53; };
  std::vector<double> numbers;
  while (numbers.size() < count) {  // Box and Muller
    const double radius = std::sqrt(-2 * std::log(1 - unit())), angle = 2 * std::numbers::pi * unit();
    numbers.push_back(radius * std::cos(angle));
    numbers.push_back(radius * std::sin(angle));
  }
  numbers.resize(count);
  return numbers;
}

GaussianField::GaussianField(std::uint64_t seed, double length_km, int waves) {
  assert(length_km > 0 && waves > 0);
  const auto count = static_cast<std::size_t>(waves);
  const std::vector<double> normal = normal_numbers(3 * count, 2 * seed);
  std::mt19937_64 random(2 * seed + 1);
  for (std::size_t i = 0; i < count; ++i)
    waves_.push_back({{normal[3 * i] / length_km, normal[3 * i + 1] / length_km, normal[3 * i + 2] / length_km},
                      2 * std::numbers::pi * static_cast<double>(random() >> 11) * 0x1.0p-53});
}

double GaussianField::at(const Vector3& p) const {
  double sum = 0;
  for (const Wave& wave : waves_)
    sum +=
        std::cos(wave.vector_per_km.x * p.x + wave.vector_per_km.y * p.y + wave.vector_per_km.z * p.z + wave.phase_rad);
  return sum * std::sqrt(2 / static_cast<double>(waves_.size()));
}

std::vector<double> GaussianField::at(std::span<const Vector3> positions_km) const {
  std::vector<double> values(positions_km.size());
  parallel_ranges(values.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = at(positions_km[i]);
  });
  return values;
}

}  // namespace thin
