#include "libemap/rendering/map_geometry.h"

#include <gtest/gtest.h>

#include <set>

#include "libemap/rendering/smooth_normals.h"
#include "libemap/surface/triangle_tree.h"
#include "tests/support/random32.h"
#include "tests/support/sampled_surfaces.h"

namespace emap {
namespace {

struct Place {
  std::uint32_t row, column;
};

Place place_of(std::uint16_t index) {
  const std::uint32_t row = index >> 8;
  return {row, (index & 255U) ^ ((row & 7U) << 5)};
}

std::size_t stored_at(const MapGeometry& geometry, const MapTile& tile, const Place& place) {
  return static_cast<std::size_t>(geometry.rows[tile.first_row + place.row].offset +
                                  static_cast<std::int32_t>(place.column));
}

Eigen::Vector3d position_of(const MapGeometry& geometry, const MapTile& tile, std::uint16_t index) {
  const Place place = place_of(index);
  const std::uint16_t code = geometry.elevations[stored_at(geometry, tile, place)];
  EXPECT_NE(code, MapGeometry::kNothing);
  return (tile.model_from_grid * Eigen::Vector4d(place.column, place.row, code, 1)).head<3>();
}

TEST(MapGeometryTest, PlacesInTheGridAreTakenApartAgain) {
  std::set<std::uint16_t> seen;
  for (std::uint32_t row = 0; row < 256; ++row)
    for (std::uint32_t column = 0; column < 256; ++column) {
      const std::uint16_t index = place_in_grid(row, column);
      EXPECT_EQ(place_of(index).row, row);
      EXPECT_EQ(place_of(index).column, column);
      seen.insert(index);
    }
  EXPECT_EQ(seen.size(), 65536U);
}

TEST(MapGeometryTest, NormalsKeepTheirDirection) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  test::Random32 random(seed);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d normal = Eigen::Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
    EXPECT_LT((normal_of(polar_normal(normal)) - normal).norm(), 6e-5);  // 0.003 degrees
  }
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(-1, 0, 0)})
    EXPECT_LT((normal_of(polar_normal(axis)) - axis).norm(), 1e-4);
}

TEST(MapGeometryTest, ASpheresNormalsAreExactWhateverItsTriangles) {
  const Mesh sphere = test::sphere(20);
  const std::vector<Eigen::Vector3d> normals = smooth_normals(sphere);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_LT((normals[i] - sphere.positions[i].normalized()).norm(), 1e-9);
}

// Every sample is drawn at its place: as a splat, and in strips and seams.
TEST(MapGeometryTest, SamplesAreWhereTheMapsHaveThem) {
  const Mesh sphere = test::sphere(40);
  const ElevationMaps maps = test::sampled(sphere, 1).maps;
  const BoundingBox box = bounding_box(sphere.positions);
  const MapGeometry geometry = map_geometry(maps, box, MapUse::interpolated_splats);
  std::size_t i = 0, tile = 0;
  for (const ElevationPatch& patch : maps.patches) {
    if (patch.columns == 0 || patch.rows == 0) continue;
    std::size_t splat = geometry.tiles[tile].first_splat;
    for (std::uint32_t row = 0; row < patch.rows; ++row)
      for (std::uint32_t column = 0; column < patch.columns; ++column) {
        if (!patch.mask[row * patch.columns + column]) continue;
        const Eigen::Vector3d expected = sample_position(patch, maps.spacing, row, column) / box.diagonal();
        EXPECT_LT((position_of(geometry, geometry.tiles[tile], geometry.splats[splat++]) - expected).norm(), 1e-5);
        ++i;
      }
    ++tile;
  }
  EXPECT_EQ(i, geometry.samples);
  EXPECT_EQ(geometry.splats.size(), geometry.samples);
}

TEST(MapGeometryTest, FilledMeshHasTheClosedMeshsTriangles) {
  const Mesh torus = test::torus(24);
  const ElevationMaps maps = test::sampled(torus, 1).maps;
  const ClosedMesh closed = closed_mesh(maps);
  const MapGeometry geometry = map_geometry(maps, bounding_box(torus.positions), MapUse::filled_mesh);
  EXPECT_EQ(geometry.triangles, closed.mesh.triangles.size());
  EXPECT_EQ(geometry.seam_triangles.size(), 3 * closed.filling.inserted);
  // Seams meet the strips: their vertices are samples of the closed mesh.
  const double diagonal = bounding_box(torus.positions).diagonal();
  const TriangleTree tree(closed.mesh);
  for (const auto& [tile, index] : geometry.seam_vertices) {
    const Eigen::Vector3d place = diagonal * position_of(geometry, geometry.tiles[tile], index);
    EXPECT_LT(std::sqrt(tree.closest(place).distance_squared), 1e-4 * diagonal);
  }
}

TEST(MapGeometryTest, LargePatchesBecomeTilesThatAgreeWhereTheyMeet) {
  const Mesh waves = test::waves(60);
  const ElevationMaps maps = test::sampled(waves, 0.15).maps;
  ASSERT_GT(maps.patches[0].columns, 300U);
  ASSERT_GT(maps.patches[0].rows, 300U);
  const BoundingBox box = bounding_box(waves.positions);
  const MapGeometry splats = map_geometry(maps, box, MapUse::interpolated_splats);
  EXPECT_GT(splats.tiles.size(), maps.patches.size());
  EXPECT_EQ(splats.splats.size(), splats.samples);  // none twice, none lost
  const MapGeometry mesh = map_geometry(maps, box, MapUse::filled_mesh);
  EXPECT_EQ(mesh.triangles, closed_mesh(maps).mesh.triangles.size());
}

// Rims lie on the surface, and stay within what is asked for.
TEST(MapGeometryTest, OverlappingPatchesGoOnAsTheSurfaceDoes) {
  const Mesh sphere = test::sphere(40);
  const ElevationMaps maps = test::sampled(sphere, 1).maps;
  const Mesh closed = closed_mesh(maps).mesh;
  const TriangleTree tree(closed);
  for (const DressedPatch& patch : dressed_patches(maps, closed, 2)) {
    std::array<std::size_t, 4> count{};
    for (std::uint32_t row = 0; row < patch.map.rows; ++row)
      for (std::uint32_t column = 0; column < patch.map.columns; ++column) {
        const std::size_t place = row * patch.map.columns + column;
        ++count[patch.ring[place]];
        EXPECT_EQ(patch.map.mask[place], patch.ring[place] ? 1 : 0);
        if (!patch.ring[place]) continue;
        const Eigen::Vector3d position = sample_position(patch.map, maps.spacing, row, column);
        EXPECT_LT(std::sqrt(tree.closest(position).distance_squared), 1e-6);
        const Eigen::Vector3d normal = patch.normal[place].cast<double>();
        const BasePlane& plane = patch.map.plane;
        const Eigen::Vector3d in_space =
            normal.x() * plane.axis_u + normal.y() * plane.axis_v + normal.z() * plane.normal;
        EXPECT_LT(std::acos(std::min(1.0, in_space.dot(position.normalized()))), 0.1);
      }
    if (count[1] < 50) continue;
    EXPECT_GT(count[2], std::sqrt(count[1]));
    EXPECT_GT(count[3], std::sqrt(count[1]));
  }
}

// A plain with a step across it: splats beside the step are wide, and none is lost or listed twice.
TEST(MapGeometryTest, SplatsThatTrianglesLeaveAreWide) {
  for (const double step : {0.0, 1.0}) {
    ElevationMaps maps;
    maps.spacing = 1;
    ElevationPatch patch;
    patch.columns = 12;
    patch.rows = 10;
    patch.mask.assign(120, 1);
    for (std::size_t place = 0; place < 120; ++place) patch.elevation.push_back(place % 12 < 6 ? 0 : step);
    maps.patches.push_back(patch);
    const MapGeometry geometry = map_geometry(maps, {{0, 0, 0}, {11, 9, 1}}, MapUse::splats);
    ASSERT_EQ(geometry.tiles.size(), 1U);
    const MapTile& tile = geometry.tiles[0];
    EXPECT_EQ(std::set(geometry.splats.begin(), geometry.splats.end()).size(), 120U);
    EXPECT_EQ(tile.splat_count, 120U);
    EXPECT_EQ(tile.wide_count > 0, step > 0);
    for (std::uint32_t i = 0; i < tile.splat_count; ++i) {
      const bool beside_step = std::abs(static_cast<int>(place_of(geometry.splats[i]).column) - 6) <= 2;
      EXPECT_TRUE(beside_step || i < tile.splat_count - tile.wide_count);
    }
  }
}

TEST(MapGeometryTest, BytesAreThoseOfTheLists) {
  const ElevationMaps maps = test::sampled(test::waves(20), 1).maps;
  const MapGeometry geometry = map_geometry(maps, {{0, 0, -0.05}, {1, 1, 0.05}}, MapUse::splats);
  EXPECT_EQ(geometry.bytes(), 128 * geometry.tiles.size() + 4 * geometry.rows.size() + 6 * geometry.elevations.size() +
                                  2 * geometry.splats.size());
}

}  // namespace
}  // namespace emap
