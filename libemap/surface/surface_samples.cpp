#include "libemap/surface/surface_samples.h"

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

}  // namespace

std::vector<Eigen::Vector3d> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  const double area = surface_area(mesh);
  std::vector<Eigen::Vector3d> samples;
  if (!(area > 0)) return samples;
  samples.reserve(count);
  Random random(seed);
  double passed = 0;  // area of the triangles before the current one
  std::size_t triangle = 0;
  double current = scaled_normal(mesh, mesh.triangles[0]).norm() / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const double target = (static_cast<double>(i) + random.next()) / static_cast<double>(count) * area;
    while (triangle + 1 < mesh.triangles.size() && passed + current < target) {
      passed += current;
      current = scaled_normal(mesh, mesh.triangles[++triangle]).norm() / 2;
    }
    const auto& corners = mesh.triangles[triangle];
    const double along = std::sqrt(random.next()), across = random.next();
    samples.push_back((1 - along) * mesh.positions[corners[0]] + along * (1 - across) * mesh.positions[corners[1]] +
                      along * across * mesh.positions[corners[2]]);
  }
  return samples;
}

}  // namespace emap
