#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "libemap/elevation/canonical_mesh.h"
#include "libemap/rendering/drawn_surface.h"

namespace emap {
namespace {

constexpr std::size_t kTexelsOfFrame = 12;  // as the shaders count them
constexpr double kWideSplats = 1.5;         // times the radius

Stage stage_of(Pass pass) {
  switch (pass) {
    case Pass::mesh:
      return Stage::map_mesh;
    case Pass::splats:
      return Stage::map_splats;
    case Pass::interpolated:
      return Stage::map_interpolated;
    case Pass::identity:
      return Stage::map_identity;
    case Pass::resolve:
      return Stage::map_resolve;
    case Pass::visibility:
      return Stage::map_visibility;
    case Pass::accumulation:
      return Stage::map_accumulation;
  }
  return Stage::map_mesh;
}

class DrawnMaps : public DrawnSurface {
 public:
  explicit DrawnMaps(const MapGeometry& geometry)
      : tiles_(geometry.tiles),
        spacing_(geometry.spacing),
        elevations_(geometry.elevations, GL_R16UI),
        normals_(geometry.normals, GL_RG16UI),
        rows_(rows_on_the_card(geometry)),
        nothing_(gl_vertex_array()) {
    strips_ = gl_buffer(GL_ELEMENT_ARRAY_BUFFER, geometry.strips);
    splats_ = gl_buffer(GL_ELEMENT_ARRAY_BUFFER, geometry.splats);
    load_seams(geometry);
  }

  thin::Result<void> draw(Pass pass, Shading shading, int rounds, const View& view, ShaderSet& shaders) override {
    elevations_.bind(kElevationsUnit);
    normals_.bind(kNormalsUnit);
    rows_.bind(kRowsUnit);
    const bool shows_surface = pass == Pass::mesh || pass == Pass::interpolated || pass == Pass::resolve;
    if (shows_surface) update_frames(view);
    const auto program = shaders.use(stage_of(pass), shading, rounds, view);
    if (!program) return program.error();
    glBindVertexArray(nothing_.get());
    if (pass == Pass::resolve)
      resolve();
    else
      draw_tiles(**program, pass, view);
    return shows_surface && seam_count_ > 0 ? draw_seams(pass, shading, view, shaders) : thin::Result<void>();
  }

 private:
  static BufferTexture rows_on_the_card(const MapGeometry& geometry) {
    if (geometry.needs_row_ends) return BufferTexture(geometry.rows, GL_RG32I);
    std::vector<std::int32_t> offsets;
    for (const MapRow& row : geometry.rows) offsets.push_back(row.offset);
    return BufferTexture(offsets, GL_R32I);
  }

  void load_seams(const MapGeometry& geometry) {
    seam_count_ = static_cast<GLsizei>(geometry.seam_triangles.size());
    if (seam_count_ == 0) return;
    seam_array_ = gl_vertex_array();
    seam_vertices_ = gl_buffer(GL_ARRAY_BUFFER, geometry.seam_vertices);
    glVertexAttribIPointer(0, 2, GL_UNSIGNED_SHORT, 4, nullptr);
    glEnableVertexAttribArray(0);
    seam_type_ = geometry.seam_vertices.size() <= 65536 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    seam_triangles_ =
        seam_type_ == GL_UNSIGNED_INT
            ? gl_buffer(GL_ELEMENT_ARRAY_BUFFER, geometry.seam_triangles)
            : gl_buffer(GL_ELEMENT_ARRAY_BUFFER,
                        std::vector<std::uint16_t>(geometry.seam_triangles.begin(), geometry.seam_triangles.end()));
  }

  // Where a disc is in front of the farthest depth, which it leaves as it is.
  static void resolve() {
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
  }

  void draw_tiles(const GlProgram& program, Pass pass, const View& view) const {
    const bool is_mesh = pass == Pass::mesh;
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, is_mesh ? strips_.get() : splats_.get());
    program.set("spacing", spacing_);
    program.set("keeps_own_normal", seam_count_ == 0 ? 1 : 0);
    for (const std::size_t i : from_front_to_back(view)) {
      const MapTile& tile = tiles_[i];
      const std::uint32_t count = is_mesh ? tile.strip_count : tile.splat_count;
      if (count == 0) continue;
      set_tile(program, tile, pass, view);
      if (pass == Pass::identity) program.set("tile", static_cast<int>(i));
      if (is_mesh) {
        draw_indices(GL_TRIANGLE_STRIP, tile.first_strip, count);
        continue;
      }
      const std::uint32_t ordinary = count - tile.wide_count;
      program.set("widening", 1.0);
      draw_indices(GL_POINTS, tile.first_splat, ordinary);
      if (tile.wide_count == 0) continue;
      program.set("widening", kWideSplats);
      draw_indices(GL_POINTS, tile.first_splat + ordinary, tile.wide_count);
    }
  }

  static void draw_indices(GLenum what, std::size_t first, std::uint32_t count) {
    glDrawElements(what, static_cast<GLsizei>(count), GL_UNSIGNED_SHORT,
                   reinterpret_cast<const void*>(sizeof(std::uint16_t) * first));
  }

  // So that what is hidden is mostly found to be before it is shaded.
  std::vector<std::size_t> from_front_to_back(const View& view) const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < tiles_.size(); ++i)
      order.emplace_back((tiles_[i].middle - view.eye_in_model).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> tiles;
    for (const auto& [distance, tile] : order) tiles.push_back(tile);
    return tiles;
  }

  static void set_tile(const GlProgram& program, const MapTile& tile, Pass pass, const View& view) {
    const Eigen::Matrix4d eye_from_grid = view.eye_from_model * tile.model_from_grid;
    program.set("first_row", static_cast<int>(tile.first_row));
    program.set("eye_from_plane", Eigen::Matrix3d(view.model_from_eye.transpose() * tile.model_from_plane));
    if (pass == Pass::mesh)
      program.set("clip_from_grid", Eigen::Matrix4d(view.clip_from_eye * eye_from_grid));
    else
      program.set("eye_from_grid", eye_from_grid);
    if (pass != Pass::visibility && pass != Pass::accumulation && pass != Pass::identity)
      program.set("patch_colour", patch_colour(tile.patch));
    if (pass != Pass::interpolated) return;
    const Eigen::Matrix4d grid_from_eye = eye_from_grid.inverse();
    program.set("grid_from_eye", grid_from_eye);
    program.set("eye_in_grid", Eigen::Vector3d(grid_from_eye.col(3).head<3>()));
    program.set("tile_first_row", static_cast<int>(tile.first_row));
    program.set("tile_row_count", static_cast<int>(tile.row_count));
    program.set("tile_steepest", steepest_squared(tile));
  }

  // The canonical mesh's limit, in elevation codes to a sample's step.
  static double steepest_squared(const MapTile& tile) {
    const double steepest = std::tan(CanonicalOptions().steepest_degrees * std::numbers::pi / 180) *
                            tile.model_from_grid.col(0).norm() / tile.model_from_grid.col(2).norm();
    return steepest * steepest;
  }

  // What shaders that see all tiles at once read of each.
  void update_frames(const View& view) {
    std::vector<std::array<float, 4>> frames;
    frames.reserve(kTexelsOfFrame * tiles_.size());
    const auto push = [&](const Eigen::Vector3d& xyz, double w) {
      frames.push_back({static_cast<float>(xyz.x()), static_cast<float>(xyz.y()), static_cast<float>(xyz.z()),
                        static_cast<float>(w)});
    };
    for (const MapTile& tile : tiles_) {
      const Eigen::Matrix4d eye_from_grid = view.eye_from_model * tile.model_from_grid;
      const Eigen::Matrix4d clip_from_grid = view.clip_from_eye * eye_from_grid;
      const Eigen::Matrix3d eye_from_plane = view.model_from_eye.transpose() * tile.model_from_plane;
      for (int column = 0; column < 4; ++column) push(clip_from_grid.col(column).head<3>(), clip_from_grid(3, column));
      push(eye_from_plane.col(0), tile.first_row);
      push(eye_from_plane.col(1), 0);
      push(eye_from_plane.col(2), 0);
      push(eye_from_grid.col(0).head<3>(), tile.first_row);
      push(eye_from_grid.col(1).head<3>(), tile.row_count);
      push(eye_from_grid.col(2).head<3>(), steepest_squared(tile));
      push(eye_from_grid.col(3).head<3>(), 1 / eye_from_grid.col(2).head<3>().squaredNorm());
      push(patch_colour(tile.patch), 0);
    }
    glActiveTexture(GL_TEXTURE0 + kFramesUnit);
    frames_ = BufferTexture(frames, GL_RGBA32F);
    frames_.bind(kFramesUnit);
  }

  thin::Result<void> draw_seams(Pass pass, Shading shading, const View& view, ShaderSet& shaders) {
    const Stage stage = pass == Pass::mesh           ? Stage::seam_mesh
                        : pass == Pass::interpolated ? Stage::seam_between_splats
                                                     : Stage::seam_over_discs;
    const auto program = shaders.use(stage, shading, 0, view);
    if (!program) return program.error();
    (*program)->set("patch_colour", Eigen::Vector3d(0.8, 0.8, 0.8));
    glBindVertexArray(seam_array_.get());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, seam_triangles_.get());
    if (view.one_sided) glEnable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, seam_count_, seam_type_, nullptr);
    glDisable(GL_CULL_FACE);
    return {};
  }

  std::vector<MapTile> tiles_;
  double spacing_;
  BufferTexture elevations_, normals_, rows_, frames_;
  GlVertexArray nothing_, seam_array_;  // tiles need no vertex attributes
  GlBuffer strips_, splats_, seam_vertices_, seam_triangles_;
  GLsizei seam_count_ = 0;
  GLenum seam_type_ = GL_UNSIGNED_INT;
};

}  // namespace

Eigen::Vector3d patch_colour(std::uint32_t patch) {
  const double hue = 6 * std::fmod(0.61803398875 * patch + 0.1, 1.0);
  const auto channel = [hue](double peak) {
    double away = std::abs(hue - peak);
    away = std::min(away, 6 - away);
    return 0.35 + 0.6 * std::clamp(2 - away, 0.0, 1.0);
  };
  return {channel(0), channel(2), channel(4)};
}

std::unique_ptr<DrawnSurface> drawn_maps(const MapGeometry& geometry) {
  return std::make_unique<DrawnMaps>(geometry);
}

}  // namespace emap
