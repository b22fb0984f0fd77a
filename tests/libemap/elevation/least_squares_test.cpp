#include "libemap/elevation/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/surface/surface_distance.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

ElevationMaps fine_maps(const Mesh& mesh, const test::SampledMesh& sampled) {
  return resample_mesh(mesh, sampled.partition, sampled.planes, fitting_spacing(sampled.maps.spacing));
}

TEST(LeastSquares, HasAboutFiveSamplesPerUnknown) {
  EXPECT_NEAR(std::pow(1 / fitting_spacing(1), 2), 5, 1e-12);
}

// From the canonical mesh to the surface: the other way round the gaps between the patches, which no fit closes, would
// drown what it gains.
double distance_of_canonical_mesh(const ElevationMaps& maps, const Mesh& mesh) {
  const Mesh canonical = canonical_mesh(maps);
  return compare_surfaces({mesh.positions, {}, mesh.triangles}, {canonical.positions, {}, canonical.triangles},
                          {.samples = 20000})
      ->second_to_first.root_mean_square;
}

TEST(LeastSquares, LowersTheErrorAsTheThesisSays) {
  const Mesh mesh = test::sphere(80);
  test::SampledMesh sampled = test::sampled(mesh, 2);
  const double before = distance_of_canonical_mesh(sampled.maps, mesh);
  fit_elevations(fine_maps(mesh, sampled), sampled.maps);
  EXPECT_LT(distance_of_canonical_mesh(sampled.maps, mesh), 0.8 * before);
}

// The heights of the canonical triangles of `maps`, at the samples of `fine`, by their triangles one after the other.
double squared_misfit(const ElevationPatch& fine, double fine_spacing, const ElevationPatch& patch, double spacing,
                      Eigen::MatrixXd* normal_matrix, Eigen::VectorXd* right) {
  double sum = 0;
  const Mesh mesh = canonical_mesh({spacing, 1, {0, 0, 0}, {patch}}, {.steepest_degrees = 89.99});
  for (std::uint32_t row = 0; row < fine.rows; ++row)
    for (std::uint32_t column = 0; column < fine.columns; ++column) {
      if (!fine.mask[row * fine.columns + column]) continue;
      const double height = fine.elevation[row * fine.columns + column];
      for (const auto& [a, b, c] : mesh.triangles) {
        Eigen::Matrix3d corners;
        const std::array<std::uint32_t, 3> unknowns = {a, b, c};
        for (int i = 0; i < 3; ++i)
          corners.col(i) << mesh.positions[unknowns[static_cast<std::size_t>(i)]].head<2>(), 1;
        const Eigen::Vector3d weights =
            corners.fullPivLu().solve(Eigen::Vector3d(column * fine_spacing, row * fine_spacing, 1));
        if (weights.minCoeff() < 0) continue;
        double interpolated = 0;
        for (int i = 0; i < 3; ++i)
          interpolated += weights[i] * mesh.positions[unknowns[static_cast<std::size_t>(i)]].z();
        sum += std::pow(interpolated - height, 2);
        for (int i = 0; normal_matrix && i < 3; ++i) {
          for (int j = 0; j < 3; ++j)
            (*normal_matrix)(unknowns[static_cast<std::size_t>(i)], unknowns[static_cast<std::size_t>(j)]) +=
                weights[i] * weights[j];
          (*right)(unknowns[static_cast<std::size_t>(i)]) += weights[i] * height;
        }
        break;
      }
    }
  return sum;
}

TEST(LeastSquares, IsTheLeastByDenseAlgebra) {
  // All samples supported, so that places and vertices have the same numbers; a landscape without equal diagonals.
  ElevationPatch patch;
  patch.columns = 5, patch.rows = 4;
  patch.mask.assign(20, 1);
  const auto landscape = [](double x, double y) { return 0.3 * std::sin(1.3 * x) + 0.2 * std::cos(0.9 * y + 0.4 * x); };
  for (std::uint32_t i = 0; i < 20; ++i) patch.elevation.push_back(landscape(i % 5, i / 5));
  const double fine_spacing = fitting_spacing(1);
  ElevationPatch fine;
  fine.columns = 9, fine.rows = 7;
  fine.mask.assign(63, 1);
  for (std::uint32_t i = 0; i < 63; ++i)
    fine.elevation.push_back(landscape(i % 9 * fine_spacing, i / 9 * fine_spacing));
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(20, 20);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(20);
  const double before = squared_misfit(fine, fine_spacing, patch, 1, &matrix, &right);
  ElevationMaps maps{1, 1, {0, 0, 0}, {patch}};
  fit_elevations({fine_spacing, 1, {0, 0, 0}, {fine}}, maps, {.iterations = 500, .tolerance = 1e-12});
  const Eigen::Map<const Eigen::VectorXd> fitted(maps.patches[0].elevation.data(), 20);
  EXPECT_LT((matrix * fitted - right).norm(), 1e-5 * right.norm());
  EXPECT_LT(squared_misfit(fine, fine_spacing, maps.patches[0], 1, nullptr, nullptr), 0.7 * before);
}

TEST(LeastSquares, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = test::torus(30);
  test::SampledMesh all = test::sampled(mesh, 1), alone = all;
  fit_elevations(fine_maps(mesh, all), all.maps);
  const thin::ThreadLimit one(1);
  fit_elevations(fine_maps(mesh, alone), alone.maps);
  for (std::size_t i = 0; i < all.maps.patches.size(); ++i)
    EXPECT_EQ(all.maps.patches[i].elevation, alone.maps.patches[i].elevation);
}

}  // namespace
}  // namespace emap
