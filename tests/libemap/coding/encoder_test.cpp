#include "libemap/coding/encoder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libemap/coding/stream.h"
#include "libemap/elevation/canonical_mesh.h"
#include "libemap/elevation/gap_filling.h"
#include "libemap/surface/point_mesh.h"
#include "libemap/surface/point_normals.h"
#include "libemap/surface/surface_distance.h"
#include "libthin/foundation/parallel.h"

namespace emap {
namespace {

constexpr std::size_t kSamples = 50000;
constexpr double kSampling_db = 0.7;  // by which two measurements with other samples may differ

// A sphere with waves.
Mesh test_mesh() {
  constexpr std::uint32_t kColumns = 96, kRows = 48;
  Mesh mesh;
  for (std::uint32_t r = 0; r <= kRows; ++r)
    for (std::uint32_t c = 0; c < kColumns; ++c) {
      const double polar = M_PI * r / kRows, azimuth = 2 * M_PI * c / kColumns;
      const double radius =
          1 + 0.06 * std::sin(5 * azimuth) * std::pow(std::sin(polar), 3) + 0.05 * std::cos(6 * polar);
      mesh.positions.emplace_back(radius * std::sin(polar) * std::cos(azimuth),
                                  radius * std::sin(polar) * std::sin(azimuth), 1.3 * radius * std::cos(polar));
    }
  for (std::uint32_t r = 0; r < kRows; ++r)
    for (std::uint32_t c = 0; c < kColumns; ++c) {
      const std::uint32_t a = r * kColumns + c, b = r * kColumns + (c + 1) % kColumns;
      if (r > 0) mesh.triangles.push_back({a, a + kColumns, b});
      if (r + 1 < kRows) mesh.triangles.push_back({b, a + kColumns, b + kColumns});
    }
  return mesh;
}

double psnr_of(const Mesh& original, const std::vector<std::uint8_t>& stream) {
  const auto decoded = read_stream(stream);
  const Mesh mesh = closed_mesh(decoded->maps).mesh;
  const auto comparison = compare_surfaces({original.positions, {}, original.triangles},
                                           {mesh.positions, {}, mesh.triangles}, {.samples = 50000});
  return comparison->psnr_db();
}

class EncoderTest : public testing::TestWithParam<std::string> {
 protected:
  EncoderOptions options() const {
    EncoderOptions options;
    options.coder = find_elevation_coder(GetParam());
    return options;
  }
};

TEST_P(EncoderTest, KeepsToTheRate) {
  const Mesh mesh = test_mesh();
  const auto surface = mesh_to_encode(mesh, {}, kSamples);
  ASSERT_TRUE(surface.ok());
  double last_psnr = 0;
  for (const double rate : {3.0, 12.0}) {
    EncoderOptions wanted = options();
    wanted.bits_per_point = rate;
    const auto encoded = encode_surface(**surface, wanted);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    const double bits = 8 * static_cast<double>(encoded->stream.size()) / static_cast<double>(mesh.positions.size());
    EXPECT_LE(bits, rate);
    EXPECT_GT(bits, 0.85 * rate);
    EXPECT_NEAR(psnr_of(mesh, encoded->stream), encoded->psnr_db, kSampling_db);
    EXPECT_GT(encoded->psnr_db, last_psnr);
    last_psnr = encoded->psnr_db;
  }
}

TEST_P(EncoderTest, KeepsToTheQuality) {
  const Mesh mesh = test_mesh();
  const auto surface = mesh_to_encode(mesh, {}, kSamples);
  EncoderOptions wanted = options();
  wanted.psnr_db = 70;
  const auto encoded = encode_surface(**surface, wanted);
  ASSERT_TRUE(encoded.ok()) << encoded.error().message;
  EXPECT_GE(encoded->psnr_db, 70);
  EXPECT_LT(encoded->psnr_db, 71.5);
  EXPECT_NEAR(psnr_of(mesh, encoded->stream), encoded->psnr_db, kSampling_db);
}

TEST_P(EncoderTest, TheSameBytesForAnyNumberOfThreads) {
  const Mesh mesh = test_mesh();
  EncoderOptions wanted = options();
  wanted.psnr_db = 65;
  std::vector<std::vector<std::uint8_t>> streams;
  for (const int threads : {1, 2}) {
    const thin::ThreadLimit limit(threads);
    const auto surface = mesh_to_encode(mesh, {}, kSamples);
    streams.push_back(encode_surface(**surface, wanted)->stream);
  }
  EXPECT_EQ(streams[0], streams[1]);
}

INSTANTIATE_TEST_SUITE_P(Coders, EncoderTest, testing::Values("baseline", "contexts"));

TEST(Encoder, SaysWhatCannotBe) {
  const Mesh mesh = test_mesh();
  const auto surface = mesh_to_encode(mesh, {}, kSamples);
  EncoderOptions options;
  EXPECT_NE(encode_surface(**surface, options).error().message.find("bits per point"), std::string::npos);
  options.bits_per_point = 0.01;
  const auto too_few = encode_surface(**surface, options);
  ASSERT_FALSE(too_few.ok());
  EXPECT_NE(too_few.error().message.find("allow more"), std::string::npos);
}

TEST(Encoder, FewerPatchesWhereThatIsBetter) {
  const Mesh mesh = test_mesh();
  const auto surface = mesh_to_encode(mesh, {}, kSamples);
  EncoderOptions options;
  options.bits_per_point = 1.5;
  options.samples_per_diagonal = 60;
  const auto own = encode_surface(**surface, options);
  options.may_repartition = true;
  const auto chosen = encode_surface(**surface, options);
  ASSERT_TRUE(own.ok() && chosen.ok());
  EXPECT_GE(chosen->psnr_db, own->psnr_db);
  EXPECT_NEAR(psnr_of(mesh, chosen->stream), chosen->psnr_db, kSampling_db);
}

TEST(Encoder, PointsOfASphereGoThereAndBack) {
  PointSet points;
  for (int i = 0; i < 4000; ++i) {
    const double z = 1 - (2 * i + 1) / 4000.0, azimuth = 2.399963229728653 * i, r = std::sqrt(1 - z * z);
    points.positions.emplace_back(r * std::cos(azimuth), r * std::sin(azimuth), z);
  }
  const auto surface = points_to_encode(points, {}, kSamples);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  EncoderOptions options;
  options.bits_per_point = 2;
  const auto encoded = encode_surface(**surface, options);
  ASSERT_TRUE(encoded.ok()) << encoded.error().message;
  const auto decoded = read_stream(encoded->stream);
  ASSERT_TRUE(decoded.ok());
  EXPECT_TRUE(decoded->header.from_points);
  for (const Eigen::Vector3d& p : sample_points(decoded->maps).positions) EXPECT_NEAR(p.norm(), 1, 0.04);
}

TEST(Encoder, PointsDecodeToAMeshWithoutHoles) {
  PointSet points{test_mesh().positions, {}};
  ensure_normals(points);
  const auto surface = points_to_encode(points, {}, kSamples);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  EncoderOptions options;
  options.bits_per_point = 8;
  const auto encoded = encode_surface(**surface, options);
  ASSERT_TRUE(encoded.ok()) << encoded.error().message;
  EXPECT_NEAR(psnr_of(mesh_of_points(points), encoded->stream), encoded->psnr_db, kSampling_db);
  const ClosedMesh closed = closed_mesh(read_stream(encoded->stream)->maps);
  EXPECT_LT(closed.filling.edges_left, closed.mesh.triangles.size() / 1000);
}

// Normals that are smoothed say that these three triangles are one sheet.
TEST(Encoder, MeshesOfAFewTrianglesReachTheirQuality) {
  const Mesh fan{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const auto surface = mesh_to_encode(fan, {}, kSamples);
  ASSERT_TRUE(surface.ok()) << surface.error().message;
  EncoderOptions options;
  options.psnr_db = 60;
  options.may_repartition = true;
  const auto encoded = encode_surface(**surface, options);
  ASSERT_TRUE(encoded.ok()) << encoded.error().message;
  EXPECT_GT(psnr_of(fan, encoded->stream), 60 - kSampling_db);
}

TEST(Encoder, DegenerateInputIsAnErrorOrAResult) {
  const auto try_to_encode = [](Mesh mesh) {
    const auto surface = mesh_to_encode(std::move(mesh), {}, kSamples);
    if (!surface) {
      EXPECT_FALSE(surface.error().message.empty());
      return;
    }
    EncoderOptions options;
    options.psnr_db = 50;
    const auto encoded = encode_surface(**surface, options);
    EXPECT_TRUE(encoded ? read_stream(encoded->stream).ok() : !encoded.error().message.empty());
  };
  try_to_encode({});
  try_to_encode({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  try_to_encode({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
  try_to_encode({{{0, 0, 0}, {1000, 0, 0}, {1000, 0.001, 0}}, {{0, 1, 2}}});
  try_to_encode({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}});
  try_to_encode({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0.3}, {0, 0.2, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}});
}

TEST(Encoder, DegeneratePointsAreAnErrorOrAResult) {
  const auto try_to_encode = [](std::vector<Eigen::Vector3d> positions) {
    const auto surface = points_to_encode({std::move(positions), {}}, {}, kSamples);
    if (!surface) {
      EXPECT_FALSE(surface.error().message.empty());
      return;
    }
    EncoderOptions options;
    options.psnr_db = 50;
    const auto encoded = encode_surface(**surface, options);
    EXPECT_TRUE(encoded ? read_stream(encoded->stream).ok() : !encoded.error().message.empty());
  };
  try_to_encode({});
  try_to_encode({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  try_to_encode({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  try_to_encode(std::vector<Eigen::Vector3d>(30, {1, 1, 1}));
  std::vector<Eigen::Vector3d> lattice;
  for (int i = 0; i < 400; ++i) lattice.emplace_back(i % 20, i / 20, 0);
  for (int i = 0; i < 400; ++i) lattice.push_back(lattice[static_cast<std::size_t>(i)]);
  try_to_encode(lattice);
}

}  // namespace
}  // namespace emap
