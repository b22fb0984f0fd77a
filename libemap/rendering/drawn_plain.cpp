#include <cassert>

#include "libemap/rendering/drawn_surface.h"

namespace emap {
namespace {

Stage stage_of(Pass pass) {
  switch (pass) {
    case Pass::mesh:
      return Stage::plain_mesh;
    case Pass::splats:
    case Pass::interpolated:
    case Pass::identity:
    case Pass::resolve:
      return Stage::plain_splats;
    case Pass::visibility:
      return Stage::plain_visibility;
    case Pass::accumulation:
      return Stage::plain_accumulation;
  }
  return Stage::plain_mesh;
}

class DrawnPlain : public DrawnSurface {
 public:
  explicit DrawnPlain(const PlainGeometry& geometry)
      : model_from_grid_(geometry.model_from_grid),
        vertex_count_(static_cast<GLsizei>(geometry.vertices.size())),
        index_count_(static_cast<GLsizei>(geometry.triangles.size())),
        array_(gl_vertex_array()),
        vertices_(gl_buffer(GL_ARRAY_BUFFER, geometry.vertices)) {
    glVertexAttribIPointer(0, 3, GL_UNSIGNED_SHORT, sizeof(PlainVertex), nullptr);
    glVertexAttribIPointer(1, 2, GL_UNSIGNED_SHORT, sizeof(PlainVertex),
                           reinterpret_cast<const void*>(offsetof(PlainVertex, normal)));
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    if (!geometry.radii.empty()) {
      radii_ = gl_buffer(GL_ARRAY_BUFFER, geometry.radii);
      glVertexAttribPointer(2, 1, GL_FLOAT, GL_FALSE, 4, nullptr);
      glEnableVertexAttribArray(2);
    }
    if (geometry.vertices.size() <= 65536) {
      index_type_ = GL_UNSIGNED_SHORT;
      triangles_ = gl_buffer(GL_ELEMENT_ARRAY_BUFFER,
                             std::vector<std::uint16_t>(geometry.triangles.begin(), geometry.triangles.end()));
    } else {
      triangles_ = gl_buffer(GL_ELEMENT_ARRAY_BUFFER, geometry.triangles);
    }
  }

  thin::Result<void> draw(Pass pass, Shading shading, int, const View& view, ShaderSet& shaders) override {
    assert(pass != Pass::interpolated && pass != Pass::identity && pass != Pass::resolve);
    const auto program = shaders.use(stage_of(pass), shading, 0, view);
    if (!program) return program.error();
    const Eigen::Matrix4d eye_from_grid = view.eye_from_model * model_from_grid_;
    (*program)->set("eye_from_plane", Eigen::Matrix3d(view.model_from_eye.transpose()));
    (*program)->set("eye_from_grid", eye_from_grid);
    (*program)->set("clip_from_grid", Eigen::Matrix4d(view.clip_from_eye * eye_from_grid));
    (*program)->set("patch_colour", patch_colour(0));
    glBindVertexArray(array_.get());
    if (pass == Pass::mesh)
      glDrawElements(GL_TRIANGLES, index_count_, index_type_, nullptr);
    else
      glDrawArrays(GL_POINTS, 0, vertex_count_);
    return {};
  }

 private:
  Eigen::Matrix4d model_from_grid_;
  GLsizei vertex_count_, index_count_;
  GlVertexArray array_;
  GlBuffer vertices_, radii_, triangles_;
  GLenum index_type_ = GL_UNSIGNED_INT;
};

}  // namespace

std::unique_ptr<DrawnSurface> drawn_plain(const PlainGeometry& geometry) {
  return std::make_unique<DrawnPlain>(geometry);
}

}  // namespace emap
