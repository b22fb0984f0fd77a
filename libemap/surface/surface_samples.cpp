#include "libemap/surface/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "libemap/surface/mesh_normals.h"

namespace emap {
namespace {

// SplitMix64 (Steele, Lea and Flood 2014): the standard library's distributions differ between implementations.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double next() {  // in [0, 1)
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

Eigen::Vector3d random_point(const Mesh& mesh, std::size_t triangle, Random& random) {
  const auto& corners = mesh.triangles[triangle];
  const double along = std::sqrt(random.next()), across = random.next();
  return (1 - along) * mesh.positions[corners[0]] + along * (1 - across) * mesh.positions[corners[1]] +
         along * across * mesh.positions[corners[2]];
}

double area_of(const Mesh& mesh, std::size_t triangle) {
  return scaled_normal(mesh, mesh.triangles[triangle]).norm() / 2;
}

// `count` points on triangles [begin, end), one in each of as many equal shares of their area, which is not zero.
template <class Visitor>
void sample_run(const Mesh& mesh, std::size_t begin, std::size_t end, double area, std::size_t count, Random& random,
                const Visitor& visit) {
  double passed = 0;  // area of the triangles before the current one
  std::size_t triangle = begin;
  double current = area_of(mesh, triangle);
  for (std::size_t i = 0; i < count; ++i) {
    const double target = (static_cast<double>(i) + random.next()) / static_cast<double>(count) * area;
    while (triangle + 1 < end && passed + current < target) {
      passed += current;
      current = area_of(mesh, ++triangle);
    }
    visit(random_point(mesh, triangle, random));
  }
}

}  // namespace

std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  const double area = surface_area(mesh);
  std::vector<Eigen::Vector3d> samples;
  if (!(area > 0)) return samples;
  samples.reserve(count);
  Random random(seed);
  sample_run(mesh, 0, mesh.triangles.size(), area, count, random,
             [&](const Eigen::Vector3d& sample) { samples.push_back(sample); });
  return samples;
}

WeightedSamples sample_every_part(const Mesh& mesh, std::size_t count, std::size_t first_single, std::uint64_t seed) {
  WeightedSamples samples;
  const double density = static_cast<double>(count) / surface_area(mesh);
  if (!std::isfinite(density)) return samples;
  first_single = std::min(first_single, mesh.triangles.size());
  const std::size_t run_length = (first_single + count - 1) / std::max<std::size_t>(count, 1);
  Random random(seed);
  for (std::size_t begin = 0, end = 0; begin < mesh.triangles.size(); begin = end) {
    end = begin < first_single ? std::min(begin + run_length, first_single) : begin + 1;
    double area = 0;
    for (std::size_t triangle = begin; triangle < end; ++triangle) area += area_of(mesh, triangle);
    if (!(area > 0)) continue;
    const auto points = static_cast<std::size_t>(std::ceil(area * density));
    sample_run(mesh, begin, end, area, points, random,
               [&](const Eigen::Vector3d& sample) { samples.positions.push_back(sample); });
    samples.areas.resize(samples.positions.size(), area / static_cast<double>(points));
  }
  return samples;
}

}  // namespace emap
