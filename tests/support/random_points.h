#pragma once

// Point clouds of the kinds that break neighbour searches and fits.

#include <random>
#include <string>
#include <vector>

namespace thin::test {

struct PointCloud {
  std::string name;
  std::vector<double> coordinates;  // count x dimension
};

inline std::vector<PointCloud> awkward_clouds(std::size_t count, int dimension, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal;
  const std::size_t total = count * static_cast<std::size_t>(dimension);

  PointCloud uniform_cloud{"uniform", {}}, clustered{"clustered", {}}, collinear{"collinear", {}},
      duplicates{"duplicates", {}}, equal{"all equal", {}}, lattice{"lattice", {}};
  for (std::size_t i = 0; i < total; ++i) uniform_cloud.coordinates.push_back(uniform(random));
  for (std::size_t point = 0; point < count; ++point) {
    const double cluster = static_cast<double>(point % 3);
    const double along = uniform(random);
    const double which = std::floor(uniform(random) * 4);
    for (int axis = 0; axis < dimension; ++axis) {
      clustered.coordinates.push_back(cluster * (axis + 1) + 1e-3 * normal(random));
      collinear.coordinates.push_back(along * (axis - 1));
      duplicates.coordinates.push_back(which * axis);
      equal.coordinates.push_back(0.25 * axis);
      lattice.coordinates.push_back(std::floor(uniform(random) * 3));
    }
  }
  return {uniform_cloud, clustered, collinear, duplicates, equal, lattice, {"empty", {}}};
}

}  // namespace thin::test
