#include "libemap/surface/surface_distance.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "libemap/surface/surface_samples.h"
#include "libthin/foundation/parallel.h"
#include "tests/support/shared_data.h"
#include "tests/support/surfaces.h"

namespace emap {
namespace {

namespace fs = std::filesystem;

Model model_of(const Mesh& mesh) {
  return {mesh.positions, {}, mesh.triangles};
}

TEST(SurfaceDistance, OfConcentricSpheresIsTheirDifference) {
  const SurfaceComparison comparison =
      *compare_surfaces(model_of(test::sphere(60)), model_of(test::sphere(60, 1.01)), {.samples = 20000});
  EXPECT_NEAR(comparison.first_to_second.root_mean_square, 0.01, 1e-4);
  EXPECT_NEAR(comparison.second_to_first.root_mean_square, 0.01, 1e-4);
  EXPECT_NEAR(comparison.diagonal, 2 * std::sqrt(3.0), 1e-2);
  EXPECT_NEAR(comparison.psnr_db(), 20 * std::log10(comparison.diagonal / 0.01), 0.1);
}

TEST(SurfaceDistance, AgreesWithBruteForce) {
  const Mesh first = test::waves(8), second = test::waves(5);
  const SurfaceComparison comparison = *compare_surfaces(model_of(first), model_of(second), {.samples = 1000});
  double sum = 0;
  const std::vector<Eigen::Vector3d> samples = sample_surface(first, 1000, 1);
  for (const Eigen::Vector3d& sample : samples) sum += std::pow(test::brute_distance(second, sample), 2);
  EXPECT_NEAR(comparison.first_to_second.root_mean_square, std::sqrt(sum / 1000), 1e-12);
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
  const Model first = model_of(test::torus(20)), second = model_of(test::torus(13));
  const SurfaceComparison all = *compare_surfaces(first, second, {.samples = 5000});
  const thin::ThreadLimit one(1);
  const SurfaceComparison alone = *compare_surfaces(first, second, {.samples = 5000});
  EXPECT_EQ(all.error(), alone.error());
  EXPECT_EQ(all.first_to_second.maximum, alone.first_to_second.maximum);
}

TEST(SurfaceDistance, MeasuresPointsByTheirMlsSurface) {
  const Mesh fine = test::sphere(60);
  const SurfaceComparison comparison =
      *compare_surfaces(model_of(fine), Model{fine.positions, {}, {}}, {.samples = 5000});
  // Between the points the mesh is flat and the MLS surface is not: a sagitta.
  EXPECT_LT(comparison.error(), 2e-3);
  EXPECT_GT(comparison.error(), 1e-5);
}

TEST(SurfaceDistance, RefusesEmptySurfaces) {
  const Model sphere = model_of(test::sphere(4));
  EXPECT_FALSE(compare_surfaces(sphere, Model{}));
  EXPECT_FALSE(compare_surfaces(Model{{{0, 0, 0}, {1, 0, 0}}, {}, {{0, 1, 1}}}, sphere));
}

TEST(SurfaceSamples, LieOnTheSurfaceInProportionToTheArea) {
  const Mesh mesh{{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}}, {{0, 1, 2}, {3, 4, 5}}};
  std::size_t on_first = 0;
  for (const Eigen::Vector3d& sample : sample_surface(mesh, 4000, 9)) {
    on_first += sample.z() < 1;
    EXPECT_LT(test::brute_distance(mesh, sample), 1e-12);
  }
  EXPECT_NEAR(static_cast<double>(on_first), 3000, 2);
}

// An independent tool's word for it, where it is at hand and can be compiled.
TEST(SurfaceDistance, AgreesWithTheIndependentTool) {
  THIN_REQUIRE_SHARED_DATA();
  const fs::path source = thin::test::shared_data() / ".." / "tools" / "surfdist.cpp";
  if (!fs::exists(source)) GTEST_SKIP() << "no " << source;
  const fs::path folder = fs::path(testing::TempDir()) / "emap_surfdist";
  fs::create_directories(folder);
  const fs::path program = folder / "surfdist", other = folder / "other.ply", report = folder / "report";
  ASSERT_EQ(std::system(("g++ -O2 -w -std=c++17 -pthread " + source.string() + " -o " + program.string()).c_str()), 0);
  const fs::path original = thin::test::shared_data() / "models" / "screwdriver.ply";
  Model model = *read_model(original.string()), moved = model;
  const double diagonal = 1e-4 * (*compare_surfaces(model, model, {.samples = 10})).diagonal;
  for (Eigen::Vector3d& position : moved.positions)
    position += diagonal * Eigen::Vector3d(std::sin(900 * position.x()), std::cos(700 * position.y()), 1);
  ASSERT_TRUE(write_ply(other.string(), mesh_of(moved)));
  ASSERT_EQ(std::system(
                (program.string() + " " + original.string() + " " + other.string() + " > " + report.string()).c_str()),
            0);
  FILE* file = std::fopen(report.c_str(), "r");
  char line[1000] = {};
  ASSERT_NE(std::fgets(line, sizeof(line), file), nullptr);
  std::fclose(file);
  const std::string text = line;
  const double psnr_db = std::stod(text.substr(text.find("PSNR ") + 5));
  EXPECT_NEAR(compare_surfaces(model, *read_model(other.string()))->psnr_db(), psnr_db, 0.1);
}

}  // namespace
}  // namespace emap
