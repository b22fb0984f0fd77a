#include "libemap/coding/surface_to_encode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libemap/surface/mesh_normals.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

constexpr std::uint32_t kCells = 100;
constexpr std::size_t kFewSamples = 100;  // far fewer than triangles

Mesh flat_square() {
  return test::grid_mesh(kCells, kCells, [](double u, double v) { return Eigen::Vector3d(u, v, 0); });
}

double six_times_area_around(const Mesh& mesh, std::uint32_t vertex) {
  double area = 0;
  for (const auto& triangle : mesh.triangles)
    if (std::find(triangle.begin(), triangle.end(), vertex) != triangle.end())
      area += scaled_normal(mesh, triangle).norm() / 2;
  return 6 * area;
}

// One vertex of 10,000 that the decoded surface lacks.
TEST(SurfaceToEncode, MissesNoSmallPartThatIsNotDecoded) {
  const Mesh flat = flat_square();
  Mesh spiked = flat;
  const auto top = static_cast<std::uint32_t>(flat.positions.size() / 2 + kCells / 2);
  const double height = 0.03;
  spiked.positions[top].z() = height;
  const auto flat_surface = mesh_to_encode(flat, {}, kFewSamples);
  const auto spiked_surface = mesh_to_encode(spiked, {}, kFewSamples);
  ASSERT_TRUE(flat_surface.ok() && spiked_surface.ok());
  const ElevationMaps decoded = (*flat_surface)->resample((*flat_surface)->planes(), 0.005, MaskEffort::none);
  // Squared height integrated over the triangles around the top: area * height² / 6.
  const double missing = height * std::sqrt(six_times_area_around(spiked, top)) / 6 / std::sqrt(surface_area(spiked));
  EXPECT_LT((*flat_surface)->error_of(decoded), 0.1 * missing);
  EXPECT_GT((*spiked_surface)->error_of(decoded), 0.3 * missing);
  EXPECT_LT((*spiked_surface)->error_of(decoded), 3 * missing);
}

TEST(SurfaceToEncode, TakesASoupForTheMeshThatItIs) {
  const Mesh mesh = test::torus(12);
  Mesh soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : triangle) soup.positions.push_back(mesh.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const auto surface = mesh_to_encode(mesh, {}, kFewSamples), from_soup = mesh_to_encode(soup, {}, kFewSamples);
  ASSERT_TRUE(surface.ok() && from_soup.ok());
  EXPECT_EQ((*from_soup)->point_count(), soup.positions.size());
  EXPECT_EQ((*from_soup)->planes().size(), (*surface)->planes().size());
}

}  // namespace
}  // namespace emap
