#pragma once

// Elevation maps as the graphics card holds them (thesis, 5.2.1): 16-bit elevations, normals as two 16-bit angles,
// lists of the supported samples, and one matrix for each tile. There is no base grid in memory: a sample's index in
// the lists is its place in a grid of 256 x 256 that all tiles share, and the vertex shader takes it apart.

#include <array>
#include <cstdint>
#include <vector>

#include "libemap/rendering/dressed_patch.h"
#include "libemap/rendering/polar_normal.h"
#include "libemap/surface/bounding_box.h"

namespace emap {

enum class MapUse {
  filled_mesh,                      // strips, and triangles between patches where gap filling puts them
  overlapping_mesh,                 // strips over patches grown by two rims
  splats,                           // a disc for each sample and for those of the first rim
  interpolated_splats,              // a disc for each sample, interpolated within its map; triangles between
                                    // patches, and between discs that do not reach each other
  overlapping_interpolated_splats,  // as splats, with a second rim to interpolate towards
};

// A rectangle of a patch, at most 128 samples wide and 256 high.
struct MapTile {
  std::uint32_t patch = 0;
  // (column, row, elevation code, 1) -> the model, centred and scaled to a diagonal of 1.
  Eigen::Matrix4d model_from_grid = Eigen::Matrix4d::Identity();
  Eigen::Matrix3d model_from_plane = Eigen::Matrix3d::Identity();  // for normals: its columns are the plane's axes
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();                // of its samples, in the model so scaled
  std::uint32_t first_row = 0;                                     // in MapGeometry::rows
  std::uint32_t row_count = 0;
  std::uint32_t first_strip = 0, strip_count = 0;  // indices in MapGeometry::strips
  // Indices in MapGeometry::splats; the last `wide_count` of them need a radius wider than (5.1), for triangles around
  // them leave their discs.
  std::uint32_t first_splat = 0, splat_count = 0, wide_count = 0;
};

// Samples of a row are stored from its first to its last one: the sample at `column` at offset + column.
struct MapRow {
  std::int32_t offset = 0;
  std::int16_t first_column = 0, last_column = -1;  // none where last < first
};

struct MapGeometry {
  static constexpr std::uint16_t kNothing = 65535;  // elevation code between supported samples

  double spacing = 0;           // of samples, diagonals
  bool needs_row_ends = false;  // on the card; where nothing is interpolated, rows' offsets are enough
  std::vector<MapTile> tiles;
  std::vector<MapRow> rows;
  std::vector<std::uint16_t> elevations;
  std::vector<PolarNormal> normals;
  std::vector<std::uint16_t> strips, splats;                // places in their tile's grid
  std::vector<std::array<std::uint16_t, 2>> seam_vertices;  // tile, place
  std::vector<std::uint32_t> seam_triangles;                // three indices into seam_vertices each

  std::size_t samples = 0;                // of the maps, rims not counted
  std::size_t triangles = 0;              // in strips, bridges not counted, and in seams
  std::size_t open_edges = 0, edges = 0;  // of the closed surface

  std::size_t bytes() const;  // of all lists, and 128 for each tile's matrices
};

// The place of a sample in the grid of 256 x 256. Rows are rotated against each other by 32 columns, so that vertex
// caches addressed by an index's low bits hold neighbouring rows at the same time.
constexpr std::uint16_t place_in_grid(std::uint32_t row, std::uint32_t column) {
  return static_cast<std::uint16_t>((row << 8) | (column ^ ((row & 7) << 5)));
}

// box: of the model, centred and scaled by it. REQUIRES: fewer than 65,536 tiles come of it
MapGeometry map_geometry(const ElevationMaps& maps, const BoundingBox& box, MapUse use,
                         const GapFillingOptions& filling = {});

}  // namespace emap
