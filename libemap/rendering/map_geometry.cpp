#include "libemap/rendering/map_geometry.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/rendering/shaders.h"
#include "libemap/rendering/smooth_normals.h"
#include "libemap/rendering/triangle_strips.h"

namespace emap {
namespace {

// Rows of samples are stored from the first to the last one, holes and all, which narrow tiles have few of.
// Interpolation looks up samples beside a tile's own, which are stored twice.
struct TileSize {
  std::uint32_t most_columns, most_rows;
  std::uint32_t beyond;  // samples that go on beyond the tile's own, where the map does

  std::uint32_t squares_across() const { return most_columns - 1 - 2 * beyond; }
  std::uint32_t squares_down() const { return most_rows - 1 - 2 * beyond; }
};

bool interpolates(MapUse use) {
  return use == MapUse::interpolated_splats || use == MapUse::overlapping_interpolated_splats;
}

TileSize tile_size(MapUse use) {
  return interpolates(use) ? TileSize{128, 256, 2} : TileSize{64, 256, 0};
}

bool has_seams(MapUse use) {
  return use == MapUse::filled_mesh || use == MapUse::interpolated_splats;
}

int rims_of(MapUse use) {
  return has_seams(use) ? 0 : use == MapUse::splats ? 1 : 2;
}

// Of the samples, no steeper over their base planes than squares are drawn.
class TangentPlanes {
 public:
  TangentPlanes(const ElevationMaps& maps, const Mesh& mesh)
      : mesh_(mesh), most_apart_(2 * 0.12 * maps.spacing), normals_(smooth_normals(mesh)) {
    const std::vector<std::uint32_t> patches = patches_of_samples(maps);
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      const Eigen::Vector3d& up = maps.patches[patches[i]].plane.normal;
      normals_[i] = (normals_[i] + std::max(kGentlestCosine - normals_[i].dot(up), 0.0) * up).normalized();
    }
  }

  bool are_left_by(const std::array<std::uint32_t, 3>& triangle) const {
    const auto leaves = [&](std::uint32_t from, std::uint32_t to) {
      return std::abs(normals_[from].dot(mesh_.positions[to] - mesh_.positions[from])) > most_apart_;
    };
    const auto& [a, b, c] = triangle;
    return leaves(a, b) || leaves(b, a) || leaves(b, c) || leaves(c, b) || leaves(a, c) || leaves(c, a);
  }

 private:
  const Mesh& mesh_;
  double most_apart_;
  std::vector<Eigen::Vector3d> normals_;
};

class GeometryWriter {
 public:
  GeometryWriter(const ElevationMaps& maps, const BoundingBox& box, MapUse use)
      : maps_(maps),
        use_(use),
        size_(tile_size(use)),
        scale_(1 / box.diagonal()),
        centre_((box.minimum + box.maximum) / 2) {}

  MapGeometry run(const GapFillingOptions& filling) {
    const ClosedMesh closed = closed_mesh(maps_, filling);
    const std::vector<DressedPatch> patches = dressed_patches(maps_, closed.mesh, rims_of(use_));
    geometry_.spacing = maps_.spacing * scale_;
    geometry_.needs_row_ends = interpolates(use_);
    geometry_.samples = closed.mesh.positions.size();
    geometry_.open_edges = closed.filling.edges_left;
    geometry_.edges = closed.mesh.triangles.size() * 3 / 2;
    if (has_seams(use_)) vertex_places_.reserve(closed.mesh.positions.size());
    if (use_ == MapUse::splats || use_ == MapUse::overlapping_interpolated_splats) find_wide_splats(closed);
    for (std::uint32_t patch = 0; patch < patches.size(); ++patch) add_patch(patch, patches[patch]);
    if (has_seams(use_)) add_seams(closed);
    return std::move(geometry_);
  }

 private:
  // Samples [first_column, last_column) x [first_row, last_row) of a patch are stored; `squares` are drawn, and splats
  // where a square begins, or at the patch's far ends.
  struct Region {
    std::uint32_t first_column, last_column, first_row, last_row;
    SquareRange squares;
  };

  void add_patch(std::uint32_t index, const DressedPatch& patch) {
    const ElevationPatch& map = patch.map;
    if (map.columns == 0 || map.rows == 0) return;
    quantise(map);
    if (!is_wide_.empty()) {
      wide_places_.assign(map.mask.size(), 0);
      for (std::size_t place = 0; place < map.mask.size(); ++place)
        if (patch.ring[place] == 1) wide_places_[place] = is_wide_[next_vertex_++];
    }
    const std::size_t first_tile = geometry_.tiles.size();
    const auto tiles_along = [](std::uint32_t samples, std::uint32_t most, std::uint32_t squares) {
      return samples <= most ? 1U : (samples - 1 + squares - 1) / squares;
    };
    const std::uint32_t across = tiles_along(map.columns, size_.most_columns, size_.squares_across());
    const std::uint32_t down = tiles_along(map.rows, size_.most_rows, size_.squares_down());
    for (std::uint32_t y = 0; y < down; ++y)
      for (std::uint32_t x = 0; x < across; ++x) add_tile(index, patch, region_of(map, x, across, y, down));
    if (has_seams(use_)) note_vertices(map, first_tile, across, down);
  }

  Region region_of(const ElevationPatch& map, std::uint32_t x, std::uint32_t across, std::uint32_t y,
                   std::uint32_t down) const {
    const auto part = [this](std::uint32_t index, std::uint32_t count, std::uint32_t samples, std::uint32_t squares) {
      const std::uint32_t first = index * squares;
      const std::uint32_t last = index + 1 == count ? samples - 1 : first + squares;
      return std::array<std::uint32_t, 4>{first, last, first - std::min(size_.beyond, first),
                                          std::min(last + 1 + size_.beyond, samples)};
    };
    const auto column = part(x, across, map.columns, size_.squares_across());
    const auto row = part(y, down, map.rows, size_.squares_down());
    return {column[2], column[3], row[2], row[3], {column[0], column[1], row[0], row[1]}};
  }

  // One range of elevations for the whole patch, so that tiles agree where they meet.
  void quantise(const ElevationPatch& map) {
    lowest_ = std::numeric_limits<double>::infinity();
    double highest = -lowest_;
    for (std::size_t i = 0; i < map.mask.size(); ++i) {
      if (!map.mask[i]) continue;
      lowest_ = std::min(lowest_, map.elevation[i]);
      highest = std::max(highest, map.elevation[i]);
    }
    if (!(highest >= lowest_)) lowest_ = highest = 0;
    step_ = highest > lowest_ ? (highest - lowest_) / (MapGeometry::kNothing - 1) : 1;
  }

  void add_tile(std::uint32_t index, const DressedPatch& patch, const Region& region) {
    MapTile tile;
    tile.patch = index;
    place_tile(patch.map, region, tile);
    store_samples(patch, region, tile);
    const auto place = [&](std::uint32_t row, std::uint32_t column) {
      return place_in_grid(row - region.first_row, column - region.first_column);
    };
    tile.first_strip = static_cast<std::uint32_t>(geometry_.strips.size());
    tile.first_splat = static_cast<std::uint32_t>(geometry_.splats.size());
    if (use_ == MapUse::filled_mesh || use_ == MapUse::overlapping_mesh) {
      const double steepest_slope = std::tan(CanonicalOptions().steepest_degrees * std::numbers::pi / 180);
      append_strip(patch.map, maps_.spacing, steepest_slope, region.squares, place, geometry_.strips);
    } else {
      tile.wide_count = list_splats(patch, region, place);
    }
    tile.strip_count = static_cast<std::uint32_t>(geometry_.strips.size()) - tile.first_strip;
    tile.splat_count = static_cast<std::uint32_t>(geometry_.splats.size()) - tile.first_splat;
    for (std::uint32_t i = 2; i < tile.strip_count; ++i) {
      const std::uint16_t* corner = geometry_.strips.data() + tile.first_strip + i;
      geometry_.triangles += corner[0] != corner[-1] && corner[0] != corner[-2] && corner[-1] != corner[-2];
    }
    geometry_.tiles.push_back(tile);
  }

  void place_tile(const ElevationPatch& map, const Region& region, MapTile& tile) const {
    const BasePlane& plane = map.plane;
    tile.model_from_plane << plane.axis_u, plane.axis_v, plane.normal;
    const Eigen::Vector3d origin =
        plane.origin + maps_.spacing * (region.first_column * plane.axis_u + region.first_row * plane.axis_v) +
        lowest_ * plane.normal;
    tile.model_from_grid.col(0).head<3>() = scale_ * maps_.spacing * plane.axis_u;
    tile.model_from_grid.col(1).head<3>() = scale_ * maps_.spacing * plane.axis_v;
    tile.model_from_grid.col(2).head<3>() = scale_ * step_ * plane.normal;
    tile.model_from_grid.col(3).head<3>() = scale_ * (origin - centre_);
  }

  void store_samples(const DressedPatch& patch, const Region& region, MapTile& tile) {
    const ElevationPatch& map = patch.map;
    tile.first_row = static_cast<std::uint32_t>(geometry_.rows.size());
    tile.row_count = region.last_row - region.first_row;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::uint32_t row = region.first_row; row < region.last_row; ++row) {
      const std::uint8_t* mask = map.mask.data() + std::size_t{row} * map.columns;
      std::uint32_t first = region.first_column, last = region.last_column;
      while (first < last && !mask[first]) ++first;
      while (last > first && !mask[last - 1]) --last;
      const auto stored = static_cast<std::int32_t>(geometry_.elevations.size());
      const std::uint32_t left = first - region.first_column;
      geometry_.rows.push_back({stored - static_cast<std::int32_t>(left), static_cast<std::int16_t>(left),
                                static_cast<std::int16_t>(static_cast<std::int32_t>(left + last - first) - 1)});
      for (std::uint32_t column = first; column < last; ++column) {
        const std::size_t place = std::size_t{row} * map.columns + column;
        geometry_.elevations.push_back(mask[column] ? code_of(map.elevation[place]) : MapGeometry::kNothing);
        if (mask[column])
          sum += Eigen::Vector4d(column - region.first_column, row - region.first_row, geometry_.elevations.back(), 1);
        geometry_.normals.push_back(polar_normal(patch.normal[place].cast<double>()));
      }
    }
    tile.middle = (tile.model_from_grid * sum).head<3>() / std::max(sum.w(), 1.0);
  }

  std::uint16_t code_of(double elevation) const {
    return static_cast<std::uint16_t>(
        std::clamp(std::lround((elevation - lowest_) / step_), 0L, MapGeometry::kNothing - 1L));
  }

  // Returns how many are wide.
  template <class Place>
  std::uint32_t list_splats(const DressedPatch& patch, const Region& region, const Place& place) {
    const ElevationPatch& map = patch.map;
    const SquareRange& squares = region.squares;
    const std::uint32_t last_column = squares.last_column + (squares.last_column + 1 == map.columns ? 1 : 0);
    const std::uint32_t last_row = squares.last_row + (squares.last_row + 1 == map.rows ? 1 : 0);
    std::vector<std::uint16_t> wide;
    for (std::uint32_t row = squares.first_row; row < last_row; ++row)
      for (std::uint32_t column = squares.first_column; column < last_column; ++column) {
        const std::size_t there = std::size_t{row} * map.columns + column;
        if (patch.ring[there] != 1 && patch.ring[there] != 2) continue;
        (!wide_places_.empty() && wide_places_[there] ? wide : geometry_.splats).push_back(place(row, column));
      }
    geometry_.splats.insert(geometry_.splats.end(), wide.begin(), wide.end());
    return static_cast<std::uint32_t>(wide.size());
  }

  // The tile and place of each sample of the map, in the order of the closed mesh's vertices.
  void note_vertices(const ElevationPatch& map, std::size_t first_tile, std::uint32_t across, std::uint32_t down) {
    for (std::uint32_t row = 0; row < map.rows; ++row)
      for (std::uint32_t column = 0; column < map.columns; ++column) {
        if (!map.mask[std::size_t{row} * map.columns + column]) continue;
        const std::uint32_t x = std::min(column / size_.squares_across(), across - 1);
        const std::uint32_t y = std::min(row / size_.squares_down(), down - 1);
        const Region region = region_of(map, x, across, y, down);
        vertex_places_.push_back({static_cast<std::uint16_t>(first_tile + std::size_t{y} * across + x),
                                  place_in_grid(row - region.first_row, column - region.first_column)});
      }
  }

  void add_seams(const ClosedMesh& closed) {
    assert(geometry_.tiles.size() < 65536);
    const auto& triangles = closed.mesh.triangles;
    const std::size_t first_inserted = triangles.size() - closed.filling.inserted;
    for (std::size_t t = first_inserted; t < triangles.size(); ++t) add_seam_triangle(triangles[t]);
    geometry_.triangles += closed.filling.inserted;
    if (use_ == MapUse::interpolated_splats)
      for (const std::size_t t : between_squares(closed.mesh, first_inserted)) add_seam_triangle(triangles[t]);
  }

  // Triangles of the patches that leave a corner's tangent plane half-way to the next corner by more than squares
  // overlap: from the side they would be seen between the squares.
  std::vector<std::size_t> between_squares(const Mesh& mesh, std::size_t count) const {
    const TangentPlanes planes(maps_, mesh);
    std::vector<std::size_t> between;
    for (std::size_t t = 0; t < count; ++t)
      if (planes.are_left_by(mesh.triangles[t])) between.push_back(t);
    return between;
  }

  // The corners of those triangles.
  void find_wide_splats(const ClosedMesh& closed) {
    const TangentPlanes planes(maps_, closed.mesh);
    is_wide_.assign(closed.mesh.positions.size(), 0);
    for (const auto& triangle : closed.mesh.triangles)
      if (planes.are_left_by(triangle))
        for (const std::uint32_t vertex : triangle) is_wide_[vertex] = 1;
  }

  void add_seam_triangle(const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t vertex : triangle) {
      const auto [entry, is_new] =
          seam_index_.try_emplace(vertex, static_cast<std::uint32_t>(geometry_.seam_vertices.size()));
      if (is_new) geometry_.seam_vertices.push_back(vertex_places_[vertex]);
      geometry_.seam_triangles.push_back(entry->second);
    }
  }

  const ElevationMaps& maps_;
  MapUse use_;
  TileSize size_;
  double scale_;
  Eigen::Vector3d centre_;
  double lowest_ = 0, step_ = 1;  // of the patch's elevation codes
  std::vector<std::array<std::uint16_t, 2>> vertex_places_;
  std::vector<std::uint8_t> is_wide_, wide_places_;  // by vertex of the closed mesh; by place of the patch at hand
  std::size_t next_vertex_ = 0;
  std::unordered_map<std::uint32_t, std::uint32_t> seam_index_;  // in seam_vertices, by vertex of the closed mesh
  MapGeometry geometry_;
};

}  // namespace

std::size_t MapGeometry::bytes() const {
  const std::size_t seam_index_bytes = seam_vertices.size() <= 65536 ? 2 : 4;
  return 128 * tiles.size() + (needs_row_ends ? sizeof(MapRow) : sizeof(MapRow::offset)) * rows.size() +
         2 * elevations.size() + 4 * normals.size() + 2 * (strips.size() + splats.size()) + 4 * seam_vertices.size() +
         seam_index_bytes * seam_triangles.size();
}

MapGeometry map_geometry(const ElevationMaps& maps, const BoundingBox& box, MapUse use,
                         const GapFillingOptions& filling) {
  return GeometryWriter(maps, box, use).run(filling);
}

}  // namespace emap
